"""The Poincare map of a case: whole periods of the input, from phase 0 to phase 0."""

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numba import types

from wedgesweep.compiled import Pointer, borrowed, compiled
from wedgesweep.hybrid import accumulators
from wedgesweep.hybrid.interface import cycle, scales
from wedgesweep.hybrid.recorder import Recorder
from wedgesweep.hybrid.vectors import store, vector
from wedgesweep.solvers.integrate import Workspace, run, workspace
from wedgesweep.solvers.period_detection import LONGEST_PERIOD


class Memory(NamedTuple):
    """Room for a run and for what it keeps; see ``memory`` and ``Recorder``.

    ``reached`` (1,): time (s) at which the last run ended.
    """

    work: Workspace
    sums: Any
    x: Any
    velocity: Any
    normal: Any
    sticks: Any
    reached: Any
    samples_per_period: int
    energies: bool


def memory(
    rtol: float,
    samples_per_period: int,
    periods: int = LONGEST_PERIOD,
    energies: bool = True,
    forces: bool = True,
) -> Memory:
    """Room for runs that keep at most this many periods.

    ``energies``: of forces and energies the sums tell; ``forces``: normal forces are sampled.
    """
    n = periods * samples_per_period
    return Memory(
        workspace(rtol),
        accumulators.empty(),
        np.zeros(n),
        np.zeros(n),
        np.zeros((2, n if forces else 0)),
        np.zeros(n, np.bool_),
        np.zeros(1),
        samples_per_period,
        energies,
    )


def _run_periods(first, periods, y, case, keeping, memory):
    case, memory = borrowed(case), borrowed(memory)
    p = case[0]
    start, stop = first * cycle(p), (first + periods) * cycle(p)
    recorder = Recorder(
        start,
        cycle(p) / memory.samples_per_period,
        memory.energies,
        memory.sums,
        memory.x,
        memory.velocity,
        memory.normal,
        memory.sticks,
    )
    keep_from = start if keeping else stop
    outcome, state = run(start, vector(y, scales(p)), keep_from, stop, p, recorder, memory.work)
    store(state.y, y)
    memory.reached[0] = state.t
    return outcome


@cache
def period_map(kind: np.dtype) -> Pointer:
    """Compiled code for records of a type, to be called as ``run_periods`` is."""
    case = np.zeros(1, kind)
    return Pointer(_run_periods, types.int64, (0, 1, np.zeros(1), case, False, memory(1e-6, 4)))


@compiled
def run_periods(period_map, first, periods, y, case, keeping, memory):
    """Run from phase 0 of period ``first``; the states y (n,) move along. Returns how it ended."""
    return period_map(first, periods, y, case, keeping, memory)
