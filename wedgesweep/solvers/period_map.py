"""The Poincare map of a case: whole periods of the input, from phase 0 to phase 0.

Callers (shooting, batches) get records as bytes and the map as an address, so that they are compiled once for
the records of all systems and kits.
"""

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numba import types

from wedgesweep.compiled import Pointer, borrowed, compiled, inlined, inner, record_in
from wedgesweep.hybrid import accumulators
from wedgesweep.hybrid.interface import (
    clocks,
    cycle,
    free,
    impact,
    provided,
    repeats,
    scales,
)
from wedgesweep.hybrid.recorder import Recorder
from wedgesweep.hybrid.state import LOCKED
from wedgesweep.hybrid.vectors import store, vector
from wedgesweep.solvers.integrate import Workspace, initial_state, integrate, workspace
from wedgesweep.solvers.period_detection import LONGEST_PERIOD

# Room for the states of any system.
MOST_STATES = 32


class Memory(NamedTuple):
    """Room for a run and for what is recorded of it; see ``memory`` and ``Recorder``.

    ``reached`` (1,): time (s) at which the last run ended; ``free`` (MOST_STATES,): which states may take
    other values near the one reached.
    """

    work: Workspace
    sums: Any
    x: Any
    velocity: Any
    normal: Any
    sticks: Any
    reached: Any
    free: Any
    acceleration: Any
    samples_per_period: int
    summed: bool
    energies: bool


def memory(
    rtol: float,
    samples_per_period: int,
    periods: int = LONGEST_PERIOD,
    energies: bool = True,
    forces: bool = True,
    acceleration: bool = False,
    summed: bool = True,
) -> Memory:
    """Room for runs of which at most this many periods are recorded.

    ``energies``: whether the sums include forces and energies; ``forces``, ``acceleration``: whether these
    are sampled; ``summed``: whether the sums are wanted at all.
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
        np.zeros(MOST_STATES, np.bool_),
        np.zeros(n if acceleration else 0),
        samples_per_period,
        summed,
        energies,
    )


@inlined
def _run_periods(first, periods, y, p, keeping, memory):
    start, stop = first * cycle(p), (first + periods) * cycle(p)
    recorder = Recorder(
        start,
        cycle(p) / memory.samples_per_period,
        memory.summed,
        memory.energies,
        memory.sums,
        memory.x,
        memory.velocity,
        memory.normal,
        memory.sticks,
        memory.acceleration,
    )
    keep_from = start if keeping else stop
    outcome = LOCKED
    state, unique = initial_state(start, vector(y, scales(p)), p)
    if unique:
        outcome, state = integrate(state, keep_from, stop, p, recorder, memory.work)
    store(state.y, y)
    memory.free[:] = False
    store(free(state.y, p), memory.free)
    memory.reached[0] = state.t
    return outcome


@cache
def period_map(kind: np.dtype) -> Pointer:
    """Compiled code for records of a type, given as bytes, to be called as ``run_periods`` is."""

    def run_record(first, periods, y, record, keeping, memory):
        return _run_periods(first, periods, y, record_in(kind, record), keeping, borrowed(memory))

    record = np.zeros(kind.itemsize, np.uint8)
    return Pointer(run_record, types.int64, (0, 1, np.zeros(1), record, False, memory(1e-6, 4)))


class Cases(NamedTuple):
    """What callers of the map know of cases, one row each: how to run them, and what their states are.

    ``records`` (n, bytes) for ``period_map``; ``scales`` (n, S): natural sizes of the states, ``clocks``
    (n, S): whether they only count time; ``cycle`` (n,): period of the input (s), ``repeats`` (n,): whether
    all of the input repeats after it. ``impacts``: whether velocities may jump.
    """

    period_map: Any
    records: Any
    scales: Any
    clocks: Any
    cycle: Any
    repeats: Any
    impacts: bool


def prepared(records: np.ndarray) -> Cases:
    """Cases of compact records, shape (n,)."""
    n, size = len(records), count_states(records)
    found = Cases(
        period_map(records.dtype),
        records.view(np.uint8).reshape(n, -1),
        np.zeros((n, size)),
        np.zeros((n, size), np.bool_),
        np.zeros(n),
        np.zeros(n, np.bool_),
        provided(impact, dict(records.dtype.fields or {})),
    )
    describe(records, found.scales, found.clocks, found.cycle, found.repeats)
    return found


@compiled
def count_states(records):
    """Number of states of records of a type, also of a system from outside."""
    return len(scales(records[0]))


@compiled
def describe(records, of_states, counts, period, repeated):
    """Write what ``Cases`` says of records."""
    for i in range(records.size):
        p = records[i]
        store(scales(p), of_states[i])
        store(clocks(p), counts[i])
        period[i], repeated[i] = cycle(p), repeats(p)


@inner
def run_case(cases, number, first, periods, y, keeping, memory):
    """Run a case from phase 0 of period ``first``; y (n,) is replaced by the state reached.

    Returns how the run ended.
    """
    return cases.period_map(first, periods, y, cases.records[number], keeping, memory)


@compiled
def run_periods(cases, first, periods, y, keeping, memory):
    """``run_case`` of the first of the cases."""
    return run_case(cases, 0, first, periods, y, keeping, memory)
