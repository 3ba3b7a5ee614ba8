"""Whole forcing periods of one case, from phase 0 to phase 0, on whichever mechanics its record needs."""

from functools import cache
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numba import types

from wedgesweep import parameters, tally
from wedgesweep.compiled import Pointer, borrowed, compiled
from wedgesweep.extended.mode import SIZE, VELOCITY, X
from wedgesweep.solvers import extended_march, march
from wedgesweep.solvers.dormand_prince import Room, room
from wedgesweep.solvers.extended_recorder import ExtendedRecorder
from wedgesweep.solvers.march import Work, workspace
from wedgesweep.solvers.recorder import Recorder
from wedgesweep.solvers.repetition import LONGEST
from wedgesweep.solvers.sticking import LOCKED


class Tools(NamedTuple):
    """Room for runs of both mechanics and for what they keep; see ``tools``.

    ``tally`` (1,), and samples as in the recorders; ``reached`` (1,): time (s) at which the last run ended.
    """

    work: Work
    room: Room
    tally: Any
    x: Any
    velocity: Any
    contact: Any
    normal: Any
    sticks: Any
    reached: Any
    samples_per_period: int


def tools(rtol: float, samples_per_period: int, periods: int = LONGEST, forces: bool = True) -> Tools:
    """Room for runs that keep at most this many periods; ``forces``: of the extended system too."""
    n = periods * samples_per_period
    return Tools(
        workspace(rtol),
        room(rtol),
        tally.empty(),
        np.zeros(n),
        np.zeros(n),
        np.zeros((n, 5), np.int8),
        np.zeros((2, n if forces else 0)),
        np.zeros(n, np.bool_),
        np.zeros(1),
        samples_per_period,
    )


@compiled
def clear(sums):
    """Empty a tally."""
    one = sums[0]
    one.lowest, one.highest, one.normal_force = np.inf, -np.inf, np.inf
    one.peak_velocity = one.time = one.integral = 0.0
    one.stuck_time = one.lifted_time = one.dissipated = one.supplied = 0.0
    one.onsets = one.began_stuck = one.is_stuck = 0.0


def _pass_periods(first, periods, y, case, keeping, tools):
    y, case, tools = borrowed(y), borrowed(case), borrowed(tools)
    p = case[0]
    cycle = 2.0 * pi / p.omega
    start, stop = first * cycle, (first + periods) * cycle
    step = cycle / tools.samples_per_period
    if p.extended:
        recorder = ExtendedRecorder(
            start, step, tools.tally, tools.x, tools.velocity, tools.normal, tools.sticks
        )
        keep = start if keeping else stop
        outcome, tools.reached[0] = extended_march.follow(start, y, keep, stop, p, recorder, tools.room)
        return outcome
    plain = Recorder(start, step, tools.tally, tools.x, tools.velocity, tools.contact)
    state, unique = march.begin(start, y[X], y[VELOCITY], p)
    tools.reached[0] = start
    if not unique:
        return LOCKED
    outcome, state = march.march(state, stop, case, keeping, plain, tools.work)
    y[X], y[VELOCITY], tools.reached[0] = state.x, state.velocity, state.t
    return outcome


@cache
def passage() -> Pointer:
    """Compiled code that runs whole periods, to be called as ``run_periods`` is."""
    record = np.zeros(1, parameters.RECORD)
    return Pointer(_pass_periods, types.int64, (0, 1, np.zeros(SIZE), record, False, tools(1e-6, 4)))


@compiled
def run_periods(passage, first, periods, y, case, keeping, tools):
    """Run from phase 0 of period ``first``; y (SIZE,) moves along. Returns the outcome."""
    return passage(first, periods, y, case, keeping, tools)
