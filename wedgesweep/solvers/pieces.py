"""The smooth pieces of a case's equations as scipy sees them: NumPy states, compiled rates and switches.

The paper's model has two states and closed forms for sticking; an effect that needs more is in the extended
system. Both are the same to an integrator: a mode holds while its switches are positive.
"""

from typing import Any, Protocol

import numpy as np

from wedgesweep import contact as contacts
from wedgesweep import excitation, tally
from wedgesweep.compiled import compiled
from wedgesweep.damper import stiffness_and_damping
from wedgesweep.extended import mode as modes
from wedgesweep.extended import switching
from wedgesweep.extended import tally as extended_tally
from wedgesweep.extended.switches import switches as write_switches
from wedgesweep.solvers.sticking import release
from wedgesweep.solvers.trajectory import CaseError

# A contact (damper.Contact) or a mode (extended.mode.Mode).
Mode = Any
# Perturbation of a state for a Jacobian by differences, over the state's natural size.
PERTURBATION = 1e-7


class Pieces(Protocol):
    """What an integrator needs; states y have the shape of ``scale``, the natural sizes of a case.

    ``fastest``: highest angular frequency (rad/s) of the input. While the bolster sticks a piece either
    ``waits``, and tells its ``release``, or ``rides``, and has switches like all others.
    """

    scale: np.ndarray
    fastest: float

    def initial(self, t: float, y: np.ndarray) -> tuple[Mode, bool]: ...
    def waits(self, mode: Mode) -> bool: ...
    def rides(self, mode: Mode) -> bool: ...
    def release(self, t: float, stop: float, y: np.ndarray, mode: Mode) -> tuple[float, int]: ...
    def rate(self, t: float, y: np.ndarray, mode: Mode) -> np.ndarray: ...
    def jacobian(self, t: float, y: np.ndarray, mode: Mode) -> np.ndarray: ...
    def switches(self, t: float, y: np.ndarray, mode: Mode) -> np.ndarray: ...
    def first_locked(self, t: np.ndarray, y: np.ndarray, mode: Mode) -> int: ...
    def missed_switch(self, t: np.ndarray, y: np.ndarray, mode: Mode) -> bool: ...
    def successor(self, t: float, y: np.ndarray, mode: Mode, switch: int) -> tuple[Mode, bool]: ...
    def contacts(self, y: np.ndarray, mode: Mode) -> np.ndarray: ...
    def normal_forces(self, t: np.ndarray, y: np.ndarray, mode: Mode) -> np.ndarray: ...
    def add(self, sums: np.ndarray, t: np.ndarray, y: np.ndarray, weight: np.ndarray, mode: Mode) -> None: ...


def pieces_of(parameters: np.ndarray) -> Pieces:
    """Pieces of a case, from its record, shape (1,)."""
    return Extended(parameters) if parameters["extended"][0] else Base(parameters)


@compiled
def rate(t, y, contact, parameters):
    """Derivative of the state (x, x'), shape (2,)."""
    p = parameters[0]
    now = contacts.acting(y[0], y[1], excitation.acceleration(t, p), contact, p)
    return np.array([y[1], now.acceleration])


@compiled
def jacobian(t, y, contact, parameters):
    """Derivative of ``rate`` with respect to the state, shape (2, 2)."""
    p = parameters[0]
    base_acceleration = excitation.acceleration(t, p)
    by_x = by_velocity = 0.0
    if not contacts.held(contact):
        by_x, by_velocity = stiffness_and_damping(y[0], y[1], base_acceleration, contact, p)
    return np.array([[0.0, 1.0], [by_x, by_velocity]])


@compiled
def switch_values(t, y, contact, parameters):
    """All switching functions at a state, shape (SWITCHES,); inf for those a contact does not have."""
    out = np.empty(contacts.SWITCHES)
    contacts.switches(t, y[0], y[1], contact, parameters[0], out)
    return out


@compiled
def first_locked(t, y, contact, parameters):
    """Index of the first of the states, shape (2, n), at which the wedge locks; -1 if none."""
    for i in range(t.size):
        if not contacts.unique(t[i], y[0, i], y[1, i], contact, parameters[0]):
            return i
    return -1


@compiled
def missed_switch(t, y, contact, parameters):
    """Whether a switch is negative at any of the states but the ends."""
    out = np.empty(contacts.SWITCHES)
    for i in range(1, t.size - 1):
        contacts.switches(t[i], y[0, i], y[1, i], contact, parameters[0], out)
        if out.min() < 0.0:
            return True
    return False


@compiled
def normal_forces(t, y, contact, parameters):
    """Normal forces (N) on column and bolster, shape (2, n); NaN while stuck. States (2, n)."""
    out = np.full((2, t.size), np.nan)
    if not contacts.stuck(contact, parameters[0]):
        for i in range(t.size):
            base_acceleration = excitation.acceleration(t[i], parameters[0])
            now = contacts.acting(y[0, i], y[1, i], base_acceleration, contact, parameters[0])
            out[0, i], out[1, i] = now.column, now.bolster
    return out


class Base:
    """The paper's model."""

    def __init__(self, parameters: np.ndarray) -> None:
        self.parameters, self.p = parameters, parameters[0]
        self.scale = np.array([self.p["amplitude"], self.p["amplitude"] * self.p["omega"]])
        self.fastest = float(self.p["omega"])

    def initial(self, t, y):
        return contacts.initial(t, y[0], y[1], self.p)

    def waits(self, mode):
        return contacts.stuck(mode, self.p)

    def rides(self, mode):
        return False

    def release(self, t, stop, y, mode):
        return release(t, stop, y[0], mode, self.parameters)

    def rate(self, t, y, mode):
        return rate(t, y, mode, self.parameters)

    def jacobian(self, t, y, mode):
        return jacobian(t, y, mode, self.parameters)

    def switches(self, t, y, mode):
        return switch_values(t, y, mode, self.parameters)

    def first_locked(self, t, y, mode):
        return first_locked(t, y, mode, self.parameters)

    def missed_switch(self, t, y, mode):
        return missed_switch(t, y, mode, self.parameters)

    def successor(self, t, y, mode, switch):
        if self.p["set_valued"] and switch < contacts.COLUMN_NORMAL:
            y[1] = 0.0
        return contacts.successor(t, y[0], y[1], mode, switch, self.p)

    def contacts(self, y, mode):
        return np.array(mode)

    def normal_forces(self, t, y, mode):
        return normal_forces(t, y, mode, self.parameters)

    def add(self, sums, t, y, weight, mode):
        tally.add_all(sums, t, y[0], y[1], weight, mode, self.parameters)


@compiled
def extended_rate(t, y, mode, parameters):
    """Derivative of the extended state, shape (SIZE,)."""
    out = np.empty(modes.SIZE)
    switching.rate(t, y, mode, parameters[0], out)
    return out


@compiled
def extended_jacobian(t, y, mode, scale, parameters):
    """Derivative of ``extended_rate`` by central differences, shape (SIZE, SIZE)."""
    out = np.zeros((modes.SIZE, modes.SIZE))
    for column in range(modes.SIZE):
        h = PERTURBATION * (scale[column] + abs(y[column]))
        above, below = y.copy(), y.copy()
        above[column] += h
        below[column] -= h
        high = extended_rate(t, above, mode, parameters)
        out[:, column] = (high - extended_rate(t, below, mode, parameters)) / (2.0 * h)
    return out


@compiled
def extended_switches(t, y, mode, parameters):
    """All switching functions, shape (modes.SWITCHES,)."""
    out = np.empty(modes.SWITCHES)
    write_switches(t, y, mode, parameters[0], out)
    return out


@compiled
def extended_first_locked(t, y, mode, parameters):
    """As ``first_locked``, for states of shape (SIZE, n)."""
    for i in range(t.size):
        if not switching.unique(t[i], y[:, i].copy(), mode, parameters[0]):
            return i
    return -1


@compiled
def extended_missed_switch(t, y, mode, parameters):
    """As ``missed_switch``, for states of shape (SIZE, n)."""
    for i in range(1, t.size - 1):
        if extended_switches(t[i], y[:, i].copy(), mode, parameters).min() < 0.0:
            return True
    return False


@compiled
def sticking(y, mode, parameters):
    """Whether (n,) the column face sticks in states (SIZE, n)."""
    found = np.empty(y.shape[1], np.bool_)
    for i in range(found.size):
        found[i] = extended_tally.sticks(y[:, i].copy(), mode, parameters[0])
    return found


@compiled
def extended_add(sums, t, y, weight, mode, parameters):
    """Add points of one mode to the running sums; states (SIZE, n)."""
    for i in range(t.size):
        extended_tally.add(sums[0], t[i], y[:, i].copy(), weight[i], mode, parameters[0])


@compiled
def extended_normal_forces(t, y, mode, parameters):
    """As ``normal_forces``, for states of shape (SIZE, n)."""
    out = np.empty((2, t.size))
    for i in range(t.size):
        now = extended_tally.forces_and_power(t[i], y[:, i].copy(), mode, parameters[0])[0]
        out[0, i], out[1, i] = now.column, now.bolster
    return out


class Extended:
    """The extended system; what a case does not use of its states stays 0."""

    def __init__(self, parameters: np.ndarray) -> None:
        self.parameters, self.p = parameters, parameters[0]
        self.scale = modes.units(self.p)
        self.fastest = excitation.fastest(self.p)

    def initial(self, t, y):
        return switching.initial(t, y, self.p)

    def waits(self, mode):
        return False

    def rides(self, mode):
        return modes.stuck(mode, self.p)

    def release(self, t, stop, y, mode):
        message = "the extended system integrates while it sticks"
        raise AssertionError(message)

    def rate(self, t, y, mode):
        now = extended_rate(t, y, mode, self.parameters)
        if not np.isfinite(now).all():
            message = f"no normal forces at t = {t:.6g} s"
            raise CaseError(message, "locked")
        return now

    def jacobian(self, t, y, mode):
        return extended_jacobian(t, y, mode, self.scale, self.parameters)

    def switches(self, t, y, mode):
        return extended_switches(t, y, mode, self.parameters)

    def first_locked(self, t, y, mode):
        return extended_first_locked(t, y, mode, self.parameters)

    def missed_switch(self, t, y, mode):
        return extended_missed_switch(t, y, mode, self.parameters)

    def successor(self, t, y, mode, switch):
        return switching.successor(t, y, mode, switch, self.p)

    def contacts(self, y, mode):
        found = np.tile(np.array(mode[:5]), (y.shape[1], 1))
        found[sticking(y, mode, self.parameters), 0] = 0
        return found

    def normal_forces(self, t, y, mode):
        return extended_normal_forces(t, y, mode, self.parameters)

    def add(self, sums, t, y, weight, mode):
        extended_add(sums, t, y, weight, mode, self.parameters)
