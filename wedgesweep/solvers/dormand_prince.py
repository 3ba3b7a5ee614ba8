"""Dormand and Prince's 5(4) pair (1980) for the states of the extended system, with dense output.

The continuous extension of order 4 is Hairer's (Hairer, Norsett and Wanner, Solving ODEs I, 1993).
"""

from typing import Any, NamedTuple

import numpy as np

from wedgesweep.compiled import compiled, inlined
from wedgesweep.extended.mode import SIZE, SWITCHES
from wedgesweep.extended.switching import rate
from wedgesweep.solvers.step_error import over_tolerance

STAGES = 7
TIMES = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
MATRIX = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
ERROR = np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
DENSE = np.array(
    [
        -12715105075 / 11282082432,
        0.0,
        87487479700 / 32700410799,
        -10690763975 / 1880347072,
        701980252875 / 199316789632,
        -1453857185 / 822651844,
        69997945 / 29380423,
    ]
)


NOTHING = np.zeros(SIZE)


class Room(NamedTuple):
    """Room for one run: stages, states, dense output and switches; see ``room``."""

    rtol: float
    counts: Any  # evaluations, steps, switches
    stages: Any  # (STAGES, SIZE) dy/dt
    trial: Any  # (SIZE,)
    end: Any  # (SIZE,)
    dense: Any  # (5, SIZE)
    inside: Any  # (SIZE,) a state within the step
    at_start: Any  # (SWITCHES,)
    at_middle: Any
    at_end: Any
    at_point: Any


def room(rtol: float) -> Room:
    """A fresh Room for runs at a relative tolerance."""
    return Room(
        rtol,
        np.zeros(3, np.int64),
        np.zeros((STAGES, SIZE)),
        np.zeros(SIZE),
        np.zeros(SIZE),
        np.zeros((5, SIZE)),
        np.zeros(SIZE),
        np.zeros(SWITCHES),
        np.zeros(SWITCHES),
        np.zeros(SWITCHES),
        np.zeros(SWITCHES),
    )


@compiled
def step(t, h, y, mode, p, room):
    """One step from y, whose rate is ``room.stages[0]``, to ``room.end``.

    Returns the error over the tolerance, and the forces at the end.
    """
    stages, trial, end = room.stages, room.trial, room.end
    room.counts[0] += STAGES - 1
    for stage in range(1, STAGES - 1):
        _combine(h, MATRIX[stage], stage, y, stages, trial)
        rate(t + TIMES[stage] * h, trial, mode, p, stages[stage])
    _combine(h, MATRIX[STAGES - 1], STAGES - 1, y, stages, end)
    forces = rate(t + h, end, mode, p, stages[STAGES - 1])
    _combine(h, ERROR, STAGES, NOTHING, stages, trial)
    return over_tolerance(trial, y, end, room.rtol, p), forces


@inlined
def _combine(h, weights, count, y, stages, out):
    """Write y + h times the weighted sum of the first ``count`` stages."""
    for i in range(SIZE):
        out[i] = y[i]
    for j in range(count):
        weight = h * weights[j]
        for i in range(SIZE):
            out[i] += weight * stages[j, i]


@compiled
def connect_cubic(h, y, room):
    """Prepare ``inside`` for a step from y: the cubic with the states and rates of both ends."""
    dense, stages = room.dense, room.stages
    for i in range(SIZE):
        rise = room.end[i] - y[i]
        bend = h * stages[0, i] - rise
        dense[0, i], dense[1, i], dense[2, i] = y[i], rise, bend
        dense[3, i] = rise - h * stages[STAGES - 1, i] - bend
        dense[4, i] = 0.0


@compiled
def connect(h, y, room):
    """Prepare ``inside`` for the step from y that was just made."""
    connect_cubic(h, y, room)
    _combine(h, DENSE, STAGES, NOTHING, room.stages, room.dense[4])


@compiled
def inside(share, room):
    """State at a share of the step, in ``room.inside``."""
    dense, rest = room.dense, 1.0 - share
    for i in range(SIZE):
        tail = dense[3, i] + rest * dense[4, i]
        room.inside[i] = dense[0, i] + share * (dense[1, i] + rest * (dense[2, i] + share * tail))
    return room.inside
