"""Batch sweeps of a friction wedge suspension, and a diagnosis of what its model misses."""

__version__ = "0.1.0"
