"""Steady harmonics, one kind of record: a test is the harmonics of a response that repeats each period."""
