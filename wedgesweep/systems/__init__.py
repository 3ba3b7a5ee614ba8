"""Mechanical systems: what each is, and which kit of parts its records need."""

from collections.abc import Iterator

import numpy as np

from wedgesweep.effects import states
from wedgesweep.systems.suspension import hybrid  # noqa: F401
from wedgesweep.systems.suspension.parameters import compact, record_type


def state_count() -> int:
    """Number of states of the largest records."""
    return len(states.kinds(record_type().fields or {}))


def grouped(parameters: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Records, shape (n,), by the kit that they need: their places, and the compact records."""
    kits = parameters["geometry"]["kit"]
    for kit in np.unique(kits):
        rows = np.flatnonzero(kits == kit)
        yield rows, compact(parameters[rows])
