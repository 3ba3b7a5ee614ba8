"""Keeps the kept window of an extended run: quadrature nodes into the tally, states onto the phase grid."""

from typing import Any, NamedTuple

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.extended.mode import VELOCITY, X, stuck
from wedgesweep.extended.tally import add, forces_and_power
from wedgesweep.solvers.dormand_prince import inside
from wedgesweep.solvers.recorder import NODES, WEIGHTS, first_sample
from wedgesweep.solvers.sticking import GOLDEN


class ExtendedRecorder(NamedTuple):
    """Where a run is kept: a tally of shape (1,) and samples at ``start + i step`` (s).

    ``x`` and ``velocity`` have shape (n,), ``normal`` (2, n) holds the normal forces on column and bolster
    face (N; NaN while stuck), ``sticks`` (n,) whether the column face does.
    """

    start: float
    step: float
    tally: Any
    x: Any
    velocity: Any
    normal: Any
    sticks: Any


@compiled
def _turning_point(share, room):
    """Share of a step, below the given one, at which x' changes its sign."""
    low, high = 0.0, share
    before = inside(0.0, room)[VELOCITY]
    for _ in range(45):
        middle = 0.5 * (low + high)
        if inside(middle, room)[VELOCITY] * before > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@compiled
def keep(t, h, share, mode, recorder, p, room):
    """Keep a step up to some share of it."""
    tally = recorder.tally[0]
    add(tally, t, inside(0.0, room), 0.0, mode, p)
    for node in range(len(NODES)):
        s = share * NODES[node]
        add(tally, t + s * h, inside(s, room), share * h * WEIGHTS[node], mode, p)
    add(tally, t + share * h, inside(share, room), 0.0, mode, p)
    if inside(0.0, room)[VELOCITY] * inside(share, room)[VELOCITY] < 0.0:
        s = _turning_point(share, room)
        add(tally, t + s * h, inside(s, room), 0.0, mode, p)
    if room.stages[0, VELOCITY] * room.stages[6, VELOCITY] < 0.0:
        s = _fastest_point(share, room)
        add(tally, t + s * h, inside(s, room), 0.0, mode, p)
    for i in range(first_sample(t, recorder), first_sample(t + share * h, recorder)):
        if i < recorder.x.size:
            time = recorder.start + i * recorder.step
            put_sample(i, time, inside((time - t) / h, room), mode, recorder, p)


@compiled
def _fastest_point(share, room):
    """Share of a step, below the given one, at which |x'| is largest (golden section)."""
    low, high = 0.0, share
    for _ in range(40):
        left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        if abs(inside(left, room)[VELOCITY]) > abs(inside(right, room)[VELOCITY]):
            high = right
        else:
            low = left
    return 0.5 * (low + high)


@compiled
def put_sample(i, t, y, mode, recorder, p):
    """Store a sample."""
    recorder.x[i], recorder.velocity[i] = y[X], y[VELOCITY]
    recorder.sticks[i] = abs(mode.column) != 1
    if stuck(mode, p):
        recorder.normal[:, i] = np.nan
    else:
        now = forces_and_power(t, y, mode, p)[0]
        recorder.normal[0, i], recorder.normal[1, i] = now.column, now.bolster
