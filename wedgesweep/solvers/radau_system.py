"""A hybrid system as scipy sees it: NumPy states, compiled rates and event functions of one mode.

Each compiled function contains a copy of the mechanics, which takes seconds to compile. So there are four:
at the start, at an event, at one state, and along many; the last two answer several questions.
"""

from typing import Any

import numpy as np

from wedgesweep.compiled import compiled, inner
from wedgesweep.hybrid import accumulators, interface
from wedgesweep.hybrid.vectors import replaced, store, vector, weighted
from wedgesweep.solvers.integrate import MOST_EVENTS

# Perturbation of a state for a Jacobian by differences, over the state's natural size.
PERTURBATION = 1e-7
# Questions.
RATE, JACOBIAN, EVENTS = range(3)
ADD, SAMPLE, CHECK = range(3)
# Answers to CHECK.
FINE, LOCKED, MISSED = range(3)


@compiled
def description(case):
    """Natural sizes of the states (n,), and highest angular frequency of the input (rad/s)."""
    size = np.empty(len(interface.scales(case[0])))
    store(interface.scales(case[0]), size)
    return size, interface.fastest(case[0])


@compiled
def initial_mode(t, y, case):
    """Mode at the start of a run, and whether it is well-posed."""
    return interface.initial_mode(t, vector(y, interface.scales(case[0])), case[0])


@compiled
def of_mode(y, mode, case):
    """Whether contacts keep the mass at rest in a mode, and how many states it moves: the first ones."""
    p = case[0]
    now = vector(y, interface.scales(p))
    moving = len(interface.first_states(now, p)) if interface.only_first_move(now, mode, p) else len(now)
    return interface.holds(mode, p), moving


@compiled
def _transition(t, y, mode, place, case, keeping, sums):
    p = case[0]
    now = vector(y, interface.scales(p))
    if keeping:
        accumulators.add_impact(sums[0], now, mode, place, p)
    after, following, unique = interface.transition(t, now, mode, place, p)
    store(after, y)
    return following, unique


def transition(
    t: float, y: np.ndarray, mode: Any, place: int, case: np.ndarray, sums: np.ndarray | None = None
) -> tuple:
    """State, shape (n,), and mode after an event, and whether they are well-posed.

    An impact is added to the running sums, if these are given.
    """
    after, keeping = y.copy(), sums is not None
    return after, *_transition(t, after, mode, place, case, keeping, _NO_SUMS if sums is None else sums)


@inner
def _jacobian(t, y, mode, p, out):
    size, n = interface.scales(p), len(y)
    for i in range(n):
        h = PERTURBATION * (size[i] + abs(y[i]))
        above = interface.rate(t, replaced(y, i, y[i] + h), mode, p)[0]
        below = interface.rate(t, replaced(y, i, y[i] - h), mode, p)[0]
        for j in range(n):
            out[n * j + i] = (above[j] - below[j]) / (2.0 * h)


@inner
def _events(t, y, mode, p, out):
    """Write all event functions; returns their number."""
    interface.events(interface.rate(t, y, mode, p)[1], t, y, mode, p, out)
    return interface.event_count(p)


@compiled
def _at(question, t, y, ahead, mode, case, out):
    """Answer a question about a state into ``out``; how many event functions there are.

    ``ahead``: time (s) after which the event functions are asked for.
    """
    p = case[0]
    now = vector(y, interface.scales(p))
    if question == JACOBIAN:
        _jacobian(t, now, mode, p, out)
        return 0
    if question == RATE:
        store(interface.rate(t, now, mode, p)[0], out)
        return 0
    if ahead > 0.0:
        # Half-way: where a run begins the rate itself is rounding.
        now = weighted(now, ahead, (1.0,), (interface.rate(t + 0.5 * ahead, now, mode, p)[0],))
    return _events(t + ahead, now, mode, p, out)


def rate(t: float, y: np.ndarray, mode: Any, case: np.ndarray) -> np.ndarray:
    """dy/dt, shape (n,)."""
    out = np.empty(y.size)
    _at(RATE, t, y, 0.0, mode, case, out)
    return out


def jacobian(t: float, y: np.ndarray, mode: Any, case: np.ndarray) -> np.ndarray:
    """Derivative of ``rate`` by central differences, shape (n, n)."""
    out = np.empty(y.size**2)
    _at(JACOBIAN, t, y, 0.0, mode, case, out)
    return out.reshape(y.size, y.size)


def events(t: float, y: np.ndarray, mode: Any, case: np.ndarray, ahead: float = 0.0) -> np.ndarray:
    """All event functions, shape (k,), some time (s) ahead; inf for those that the mode does not have.

    A moment ahead an event that passes zero now is beyond rounding errors.
    """
    out = np.empty(MOST_EVENTS)
    return out[: _at(EVENTS, t, y, ahead, mode, case, out)]


@inner
def _sample(i, t, y, mode, p, out):
    out[0, i], out[1, i] = interface.observed(y, p)
    out[2, i], out[3, i] = interface.contact_forces(t, y, mode, p)
    out[4, i] = 1.0 if interface.sticks(y, mode, p) else 0.0
    out[5, i] = interface.observed(interface.rate(t, y, mode, p)[0], p)[1]


@inner
def _lowest_event(t, y, mode, p, out):
    lowest = np.inf
    for k in range(_events(t, y, mode, p, out)):
        lowest = min(lowest, out[k])
    return lowest


@compiled
def _along(question, points, mode, case, sums, out):
    """Answer a question about many states into ``sums`` or ``out``, or as a number.

    ``points`` (n + 2, k): times, weights, states.
    """
    p, width = case[0], interface.scales(case[0])
    room, found, last = np.empty(MOST_EVENTS), FINE, points.shape[1] - 1
    for i in range(points.shape[1]):
        t, y = points[0, i], vector(points[2:, i], width)
        if question == ADD:
            accumulators.add(sums[0], t, y, points[1, i], mode, p)
        elif question == SAMPLE:
            _sample(i, t, y, mode, p, out)
        elif not interface.well_posed(t, y, mode, p):
            return LOCKED
        elif 0 < i < last and _lowest_event(t, y, mode, p, room) < 0.0:
            found = MISSED
    return found


def _points(t: np.ndarray, y: np.ndarray, weight: np.ndarray | None = None) -> np.ndarray:
    return np.ascontiguousarray(np.vstack([t, np.zeros(t.size) if weight is None else weight, y]))


_NO_SUMS, _NO_SAMPLES = accumulators.empty(), np.empty((6, 0))


def add(
    sums: np.ndarray, t: np.ndarray, y: np.ndarray, weight: np.ndarray | None, mode: Any, case: np.ndarray
) -> None:
    """Add points of one mode to the running sums; states (n, k), weights (s; None: 0)."""
    _along(ADD, _points(t, y, weight), mode, case, sums, _NO_SAMPLES)


def sample(t: np.ndarray, y: np.ndarray, mode: Any, case: np.ndarray) -> np.ndarray:
    """What is recorded of states (n, k), shape (6, k).

    Displacement, velocity, both normal forces, whether the observed contact sticks (0 or 1), acceleration.
    """
    out = np.empty((6, t.size))
    _along(SAMPLE, _points(t, y), mode, case, _NO_SUMS, out)
    return out


def check(t: np.ndarray, y: np.ndarray, mode: Any, case: np.ndarray) -> int:
    """LOCKED if one of the states, shape (n, k), is not well-posed.

    Else MISSED if an event function is negative at any of them but the ends.
    """
    return int(_along(CHECK, _points(t, y), mode, case, _NO_SUMS, _NO_SAMPLES))
