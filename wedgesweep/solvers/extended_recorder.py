"""Keeps the kept window of an extended run: quadrature nodes into the tally, states onto the phase grid."""

from typing import Any, NamedTuple

import numpy as np

from wedgesweep.compiled import compiled, inlined
from wedgesweep.extended.mode import VELOCITY, X, stuck
from wedgesweep.extended.tally import add, forces_and_power, sticks
from wedgesweep.solvers.dormand_prince import inside
from wedgesweep.solvers.recorder import NODES, WEIGHTS, first_sample
from wedgesweep.solvers.sticking import GOLDEN
from wedgesweep.tally import add_motion


class ExtendedRecorder(NamedTuple):
    """Where a run is kept: a tally of shape (1,) and samples at ``start + i step`` (s).

    ``x`` and ``velocity`` have shape (n,), ``normal`` (2, n) holds the normal forces on column and bolster
    face (N; NaN while stuck), ``sticks`` (n,) whether the column face does. With ``normal`` of shape (2, 0)
    neither samples nor tally tell of forces and energies: that saves half of the time.
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


@inlined
def _has_forces(recorder):
    return recorder.normal.shape[1] > 0


@compiled
def _add(share, t, h, weight, mode, recorder, p, room):
    """Add the point at a share of a step to the tally; ``weight`` as a share too."""
    y = inside(share, room)
    if _has_forces(recorder):
        add(recorder.tally[0], t + share * h, y, weight * h, mode, p)
    else:
        add_motion(recorder.tally[0], y[X], y[VELOCITY], weight * h, sticks(y, mode, p))


@compiled
def keep(t, h, share, mode, recorder, p, room):
    """Keep a step up to some share of it."""
    _add(0.0, t, h, 0.0, mode, recorder, p, room)
    for node in range(len(NODES)):
        _add(share * NODES[node], t, h, share * WEIGHTS[node], mode, recorder, p, room)
    _add(share, t, h, 0.0, mode, recorder, p, room)
    if inside(0.0, room)[VELOCITY] * inside(share, room)[VELOCITY] < 0.0:
        _add(_turning_point(share, room), t, h, 0.0, mode, recorder, p, room)
    if room.stages[0, VELOCITY] * room.stages[6, VELOCITY] < 0.0:
        _add(_fastest_point(share, room), t, h, 0.0, mode, recorder, p, room)
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
    recorder.sticks[i] = sticks(y, mode, p)
    if not _has_forces(recorder):
        return
    if stuck(mode, p):
        recorder.normal[:, i] = np.nan
    else:
        now = forces_and_power(t, y, mode, p)[0]
        recorder.normal[0, i], recorder.normal[1, i] = now.column, now.bolster
