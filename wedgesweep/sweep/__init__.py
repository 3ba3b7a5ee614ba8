"""Sweeps: cases solved in parallel, stored as they finish, and assembled into one labelled dataset."""
