"""Mechanical systems, and the smallest kit of parts that a record of each needs."""

from collections.abc import Iterator

import numpy as np

from wedgesweep import friction
from wedgesweep.effects import states
from wedgesweep.excitation import has_series, set_series
from wedgesweep.systems.oscillator import hybrid as _oscillator_hybrid  # noqa: F401
from wedgesweep.systems.oscillator import parameters as oscillator_parameters
from wedgesweep.systems.suspension import hybrid as _suspension_hybrid  # noqa: F401
from wedgesweep.systems.suspension import parameters as suspension_parameters
from wedgesweep.systems.suspension.unilateral import hybrid as _unilateral_hybrid  # noqa: F401

# Systems that configs know: the module of the records, by the field that marks them.
SYSTEMS = {"suspension": suspension_parameters, "oscillator": oscillator_parameters}


def state_count() -> int:
    """Number of states of the largest records."""
    return max(len(states.kinds(each.record_type().fields or {})) for each in SYSTEMS.values())


def compact(parameters: np.ndarray) -> np.ndarray:
    """Records, shape (n,), as compiled code gets them: without the parts that none of them needs."""
    for name, system in SYSTEMS.items():
        if name in (parameters.dtype.names or ()):
            friction.require_known(parameters["friction"]["law"])
            return system.compact(parameters)
    return parameters


def is_oscillator(parameters: np.ndarray) -> bool:
    """Whether records are those of the oscillator."""
    return "oscillator" in (parameters.dtype.names or ())


def opens(parameters: np.ndarray) -> np.ndarray:
    """Whether contacts of records, shape (n,), may open."""
    if is_oscillator(parameters):
        return np.zeros(len(parameters), bool)
    return suspension_parameters.has_unilateral_joints(parameters)


def _kits(parameters: np.ndarray) -> np.ndarray:
    return parameters["oscillator" if is_oscillator(parameters) else "geometry"]["kit"]


def kits(parameters: np.ndarray) -> np.ndarray:
    """Number of the kit of parts that each record, shape (n,), needs.

    Twice the number of the system's own kit (0: the smallest), plus 1 if the input is not a sine.
    """
    return 2 * _kits(parameters) + has_series(parameters)


def example(system: str, kit: int) -> np.ndarray:
    """A case, shape (1,), that needs a kit (see ``kits``), and sticks and slips."""
    if system == "suspension":
        opens = kit // 2 in suspension_parameters.OPENING
        joints = suspension_parameters.UNILATERAL if opens else suspension_parameters.BILATERAL
        case = suspension_parameters.record("coulomb", 5e-3, 85.0, {"joints": joints})
    else:
        body = {"mass": 1.0, "spring": 7e3, "normal_force": 30.0}
        case = oscillator_parameters.record("coulomb", 5e-3, 85.0, body)
    _kits(case)[:] = kit // 2
    if kit % 2:
        set_series(case, np.array([-1j, 0.01]))
    return case


def has_own_mechanics(parameters: np.ndarray) -> np.ndarray:
    """Whether effects of records, shape (n,), need more than the base model's mechanics."""
    return _kits(parameters) != 0


def driven_mass(parameters: np.ndarray) -> np.ndarray:
    """Mass (kg) that the base acceleration drives, of records of any shape."""
    if is_oscillator(parameters):
        return parameters["oscillator"]["mass"]
    return suspension_parameters.driven_mass(parameters)


def moving_mass(parameters: np.ndarray) -> np.ndarray:
    """Mass (kg) that the motion accelerates, of records of any shape."""
    if is_oscillator(parameters):
        return parameters["oscillator"]["mass"]
    return suspension_parameters.moving_mass(parameters)


def grouped(parameters: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield the records, shape (n,), that need the same kit: their places, and the compact records."""
    needed = kits(parameters)
    for kit in np.unique(needed):
        rows = np.flatnonzero(needed == kit)
        yield rows, compact(parameters[rows])


def set_states(parameters: np.ndarray, vectors: np.ndarray, owner: str, values: np.ndarray) -> None:
    """Put the states of an effect into state vectors, in place; nothing where a record has no room for it.

    Parameters
    ----------
    parameters : structured array, shape (n,)
        Full records.
    vectors : ndarray, shape (n, S)
        State of each, S = ``state_count()``.
    owner : str
        Name of the effect.
    values : ndarray, shape (n, k)
        Its states, in the order of its STATES (SI).
    """
    for rows, cases in grouped(parameters):
        owners = [name for name, _ in states.kinds(cases.dtype.fields or {})]
        if owner in owners:
            first = owners.index(owner)
            vectors[rows, first : first + values.shape[1]] = values[rows]
