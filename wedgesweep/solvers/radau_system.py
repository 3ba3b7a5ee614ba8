"""A hybrid system as scipy sees it: NumPy states, compiled rates and event functions of one mode."""

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.hybrid import accumulators, interface
from wedgesweep.hybrid.vectors import vector
from wedgesweep.solvers.integrate import MOST_EVENTS

# Perturbation of a state for a Jacobian by differences, over the state's natural size.
PERTURBATION = 1e-7


@compiled
def scales(case):
    """Natural sizes of the states, shape (n,)."""
    return np.array(interface.scales(case[0]))


@compiled
def fastest(case):
    """Highest angular frequency of the input (rad/s)."""
    return interface.fastest(case[0])


@compiled
def initial_mode(t, y, case):
    """Mode at the start of a run, and whether it is well-posed."""
    return interface.initial_mode(t, vector(y, interface.scales(case[0])), case[0])


@compiled
def holds(mode, case):
    """Whether contacts keep the mass at rest."""
    return interface.holds(mode, case[0])


@compiled
def rate(t, y, mode, case):
    """dy/dt, shape (n,)."""
    p = case[0]
    return np.array(interface.rate(t, vector(y, interface.scales(p)), mode, p)[0])


@compiled
def jacobian(t, y, mode, case):
    """Derivative of ``rate`` by central differences, shape (n, n)."""
    size = interface.scales(case[0])
    out = np.empty((len(size), len(size)))
    for i in range(len(size)):
        h = PERTURBATION * (size[i] + abs(y[i]))
        above, below = y.copy(), y.copy()
        above[i] += h
        below[i] -= h
        out[:, i] = (rate(t, above, mode, case) - rate(t, below, mode, case)) / (2.0 * h)
    return out


@compiled
def events(t, y, mode, case):
    """All event functions, shape (k,); inf for those that the mode does not have."""
    p = case[0]
    out = np.full(MOST_EVENTS, np.inf)
    now = vector(y, interface.scales(p))
    interface.events(interface.rate(t, now, mode, p)[1], t, now, mode, p, out)
    return out[: interface.event_count(p)]


@compiled
def transition(t, y, mode, place, case):
    """State, shape (n,), and mode after an event, and whether they are well-posed."""
    p = case[0]
    after, following, unique = interface.transition(t, vector(y, interface.scales(p)), mode, place, p)
    return np.array(after), following, unique


@compiled
def first_locked(t, y, mode, case):
    """Index of the first of the states, shape (n, k), that is not well-posed; -1 if none."""
    for i in range(t.size):
        if not interface.well_posed(t[i], vector(y[:, i], interface.scales(case[0])), mode, case[0]):
            return i
    return -1


@compiled
def missed_event(t, y, mode, case):
    """Whether an event function is negative at any of the states, shape (n, k), but the ends."""
    lowest = np.inf
    for i in range(1, t.size - 1):
        lowest = min(lowest, events(t[i], y[:, i], mode, case).min())
    return lowest < 0.0


@compiled
def add(sums, t, y, weight, mode, case):
    """Add points of one mode to the running sums; states (n, k)."""
    for i in range(t.size):
        accumulators.add(sums[0], t[i], vector(y[:, i], interface.scales(case[0])), weight[i], mode, case[0])


@compiled
def sample(t, y, mode, case):
    """What is recorded of states (n, k): displacement, velocity, sticks (k,), and normal forces (2, k)."""
    p = case[0]
    motion, sticks, normal = np.empty((2, t.size)), np.empty(t.size, np.bool_), np.empty((2, t.size))
    for i in range(t.size):
        now = vector(y[:, i], interface.scales(p))
        motion[0, i], motion[1, i] = interface.observed(now, p)
        sticks[i] = interface.sticks(now, mode, p)
        normal[0, i], normal[1, i] = interface.contact_forces(t[i], now, mode, p)
    return motion, sticks, normal


@compiled
def moment_later(t, y, moment, mode, case):
    """Event functions a moment (s) later, when one that passes zero now is beyond rounding errors."""
    # Half-way: where a run begins the rate itself is rounding.
    return events(t + moment, y + moment * rate(t + 0.5 * moment, y, mode, case), mode, case)
