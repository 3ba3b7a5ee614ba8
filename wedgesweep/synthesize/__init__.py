"""Synthetic measured data of a known truth, in the form that ``measured`` reads.

The true system is solved by Radau at a tight tolerance, never by the solver that a diagnosis fits with: data
that come from the fitted model's own integrator flatter the fit.
"""
