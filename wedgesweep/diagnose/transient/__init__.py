"""Transients, one kind of record: a free motion from an initial state that is fitted, compared in time."""
