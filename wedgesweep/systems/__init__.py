"""Mechanical systems: what each is, and which kit of parts its records need."""

from collections.abc import Iterator

import numpy as np

from wedgesweep.effects import states
from wedgesweep.excitation import has_series
from wedgesweep.systems.suspension import hybrid  # noqa: F401
from wedgesweep.systems.suspension import parameters as suspension


def state_count() -> int:
    """Number of states of the largest records."""
    return len(states.kinds(suspension.record_type().fields or {}))


def compact(parameters: np.ndarray) -> np.ndarray:
    """Records, shape (n,), as compiled code gets them: the suspension's without what they do not need."""
    own = "suspension" in (parameters.dtype.names or ())
    return suspension.compact(parameters) if own else parameters


def grouped(parameters: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Records, shape (n,), by the kit that they need: their places, and the compact records."""
    kits = 2 * parameters["geometry"]["kit"] + has_series(parameters)
    for kit in np.unique(kits):
        rows = np.flatnonzero(kits == kit)
        yield rows, compact(parameters[rows])
