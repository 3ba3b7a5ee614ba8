"""The Poincare map of a case: whole periods of the input, from phase 0 to phase 0.

Callers (shooting, batches) get records as bytes and the map as an address, so that they are compiled once for
the records of all systems and kits.

A suspension whose joints can open is followed by two systems in turn: while both contacts are closed by that
of bilateral joints, which has fewer states and is faster; else by the one with gaps.
"""

from functools import cache
from math import isnan
from typing import Any, NamedTuple

import numpy as np
from numba import types

from wedgesweep.compiled import Pointer, borrowed, by_record, compiled, inlined, inner, record_in
from wedgesweep.hybrid import accumulators
from wedgesweep.hybrid.interface import (
    clocks,
    cycle,
    free,
    impact,
    provided,
    repeats,
    scales,
    taken_over,
)
from wedgesweep.hybrid.recorder import Recorder
from wedgesweep.hybrid.state import CHATTERING, HANDED_OVER, LOCKED, State
from wedgesweep.hybrid.vectors import store, vector
from wedgesweep.solvers.integrate import EVENTS_PER_PERIOD, Workspace, initial_state, integrate, workspace
from wedgesweep.solvers.period_detection import LONGEST_PERIOD
from wedgesweep.systems import while_closed

# Room for the states and for the numbers of a mode of any system.
MOST_STATES, MOST_MODE = 32, 16
# Places in what one system hands over to another: time (s), next step (s), last event; from MODE on the mode.
TIME, STEP, EVENT, MODE = range(4)


class Memory(NamedTuple):
    """Room for a run and for what is recorded of it; see ``memory`` and ``Recorder``.

    ``reached`` (1,): time (s) at which the last run ended; ``free`` (MOST_STATES,): which states may take
    other values near the one reached; ``handed`` (MODE + MOST_MODE,): from where another system goes on, with
    a time of NaN if none does.
    """

    work: Workspace
    sums: Any
    x: Any
    velocity: Any
    normal: Any
    sticks: Any
    reached: Any
    free: Any
    handed: Any
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
        np.full(MODE + MOST_MODE, np.nan),
        np.zeros(n if acceleration else 0),
        samples_per_period,
        summed,
        energies,
    )


def _first_state(start, y, handed, p):
    """State in which a run begins, or goes on from another system, and whether it is unique."""


@inlined
def _handed_state(start, y, handed, p):
    if isnan(handed[TIME]):
        return initial_state(start, y, p)
    mode, unique = taken_over(handed[TIME], y, handed[MODE:], p)
    return State(handed[TIME], y, mode, np.int64(handed[EVENT]), handed[STEP]), unique


by_record(
    _first_state,
    lambda fields: (
        _handed_state
        if provided(taken_over, fields)
        else (lambda start, y, handed, p: initial_state(start, y, p))
    ),
)


@inlined
def _hand_over(state, handed):
    handed[TIME], handed[STEP], handed[EVENT] = state.t, state.step, state.last_event
    for i in range(len(state.mode)):
        handed[MODE + i] = state.mode[i]


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
    state, unique = _first_state(start, vector(y, scales(p)), memory.handed, p)
    if unique:
        outcome, state = integrate(state, keep_from, stop, p, recorder, memory.work)
    if outcome == HANDED_OVER:
        _hand_over(state, memory.handed)
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
    all of the input repeats after it. ``impacts``: whether velocities may jump. ``turns``: whether
    ``closed_map`` follows cases, with ``closed_records``, while their contacts are closed; that system has
    the first ``closed_states`` of the states.
    """

    period_map: Any
    records: Any
    scales: Any
    clocks: Any
    cycle: Any
    repeats: Any
    impacts: bool
    turns: Any
    closed_map: Any
    closed_records: Any
    closed_states: int


def prepared(records: np.ndarray) -> Cases:
    """Cases of compact records, shape (n,)."""
    n, size, closed = len(records), count_states(records), while_closed(records)
    smaller = records if closed is None else closed
    found = Cases(
        period_map(records.dtype),
        _as_bytes(records),
        np.zeros((n, size)),
        np.zeros((n, size), np.bool_),
        np.zeros(n),
        np.zeros(n, np.bool_),
        provided(impact, dict(records.dtype.fields or {})),
        closed is not None,
        period_map(smaller.dtype),
        _as_bytes(smaller),
        count_states(smaller),
    )
    describe(records, found.scales, found.clocks, found.cycle, found.repeats)
    return found


def _as_bytes(records: np.ndarray) -> np.ndarray:
    return records.view(np.uint8).reshape(len(records), -1)


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

    Returns how the run ended. It begins with the system for closed contacts, if the case has one and gaps and
    their rates are zero.
    """
    memory.handed[TIME] = np.nan
    closed = cases.turns
    for i in range(cases.closed_states, y.size):
        closed = closed and y[i] == 0.0
    for _ in range(EVENTS_PER_PERIOD * (1 + periods)):
        if closed:
            record = cases.closed_records[number]
            outcome = cases.closed_map(first, periods, y, record, keeping, memory)
        else:
            outcome = cases.period_map(first, periods, y, cases.records[number], keeping, memory)
        if outcome != HANDED_OVER:
            return outcome
        closed = not closed
    return CHATTERING


@compiled
def run_periods(cases, first, periods, y, keeping, memory):
    """``run_case`` of the first of the cases."""
    return run_case(cases, 0, first, periods, y, keeping, memory)
