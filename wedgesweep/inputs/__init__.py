"""Inputs that do not repeat: swept sines, random motion, ramps, recordings, and releases without any input.

A file per kind. Each turns the numbers of the table [input] (SI units) into samples.
"""
