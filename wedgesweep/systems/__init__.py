"""Mechanical systems: what each is, and which kit of parts its records need."""

from collections.abc import Iterator

import numpy as np

from wedgesweep.effects import states
from wedgesweep.excitation import has_series
from wedgesweep.systems.oscillator import hybrid as _oscillator_hybrid  # noqa: F401
from wedgesweep.systems.oscillator import parameters as oscillator
from wedgesweep.systems.suspension import hybrid as _suspension_hybrid  # noqa: F401
from wedgesweep.systems.suspension import parameters as suspension

# Systems that configs know: the module of the records, by the field that marks them.
SYSTEMS = {"suspension": suspension, "oscillator": oscillator}


def state_count() -> int:
    """Number of states of the largest records."""
    return max(len(states.kinds(system.record_type().fields or {})) for system in SYSTEMS.values())


def compact(parameters: np.ndarray) -> np.ndarray:
    """Records, shape (n,), as compiled code gets them: without what they do not need."""
    for name, system in SYSTEMS.items():
        if name in (parameters.dtype.names or ()):
            return system.compact(parameters)
    return parameters


def is_oscillator(parameters: np.ndarray) -> bool:
    """Whether records are those of the oscillator."""
    return "oscillator" in (parameters.dtype.names or ())


def _kits(parameters: np.ndarray) -> np.ndarray:
    return parameters["oscillator" if is_oscillator(parameters) else "geometry"]["kit"]


def has_own_mechanics(parameters: np.ndarray) -> np.ndarray:
    """Whether effects of records, shape (n,), need more than the base model's mechanics."""
    return _kits(parameters) != 0


def driven_mass(parameters: np.ndarray) -> np.ndarray:
    """Mass (kg) that the base acceleration drives, of records of any shape."""
    if is_oscillator(parameters):
        return parameters["oscillator"]["mass"]
    return suspension.driven_mass(parameters)


def moving_mass(parameters: np.ndarray) -> np.ndarray:
    """Mass (kg) that the motion accelerates, of records of any shape."""
    if is_oscillator(parameters):
        return parameters["oscillator"]["mass"]
    return suspension.moving_mass(parameters)


def grouped(parameters: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Records, shape (n,), by the kit that they need: their places, and the compact records."""
    kits = 2 * _kits(parameters) + has_series(parameters)
    for kit in np.unique(kits):
        rows = np.flatnonzero(kits == kit)
        yield rows, compact(parameters[rows])
