"""Synthetic measured data of a known system, in the form that ``measured`` reads.

Radau solves the true system at a tight tolerance, never the solver that a diagnosis uses: a fit to data of
its own integrator looks better than it is.
"""
