"""Compiled solver that goes from event to event, for one case or for many in one compiled loop.

Modes, rates and event functions are those of the Radau solver; between events it integrates by methods of its
own (integrate.py).
"""

from typing import Any, NamedTuple

import numpy as np

from wedgesweep import response
from wedgesweep.compiled import allocating, borrowed, compiled
from wedgesweep.hybrid.accumulators import clear
from wedgesweep.hybrid.state import CHATTERING, FAILED, LOCKED, OK
from wedgesweep.solvers.integrate import EVENTS_PER_PERIOD
from wedgesweep.solvers.period_detection import LONGEST_PERIOD
from wedgesweep.solvers.period_map import memory, prepared, run_periods
from wedgesweep.solvers.shooting import copy, run_map, settle_pointer, shooting
from wedgesweep.solvers.trajectory import CaseError, Samples, TimedWindow, Trajectory, TransientWindow, Window
from wedgesweep.systems import compact, state_count

MESSAGES = {
    LOCKED: ("locked", "normal forces not unique: the system locks"),
    FAILED: ("solver_failure", "the steps became too small, or too many"),
    CHATTERING: ("solver_failure", f"more than {EVENTS_PER_PERIOD} switches per period"),
}
STATISTICS = ("rate_evaluations", "steps", "switches")


def solve(
    parameters: np.ndarray,
    window: Window,
    rtol: float,
    time_limit: float,
    start: tuple[float, float] = (0.0, 0.0),
) -> Trajectory:
    """Run one case; arguments and errors as for ``radau.solve``.

    The compiled loop cannot be interrupted: it limits steps and events instead of the time. It samples evenly
    spaced phases only, and raises TypeError for a TimedWindow.
    """
    if isinstance(window, TimedWindow):
        raise TypeError("sample times of one's own are for radau.solve; this solver samples even phases")
    case = prepared(compact(parameters))
    room = memory(
        rtol, window.samples_per_period, window.periods, acceleration=isinstance(window, TransientWindow)
    )
    y, settle_periods, outcome = np.zeros(case.scales.shape[1]), window.settle_periods, OK
    y[:2] = start
    if settle_periods:
        outcome = run_periods(case, 0, settle_periods, y, False, room)
    if outcome == OK:
        outcome = run_periods(case, settle_periods, window.periods, y, True, room)
    if outcome != OK:
        status, message = MESSAGES[outcome]
        raise CaseError(f"{message} (at t = {room.reached[0]:.6g} s)", status)
    samples = Samples(window.sample_times, room.x, room.velocity, room.sticks, room.normal, room.acceleration)
    counts = dict(zip(STATISTICS, room.work.counts.tolist(), strict=True))
    return Trajectory(samples, room.sums, window.periods, counts)


class BatchSettings(NamedTuple):
    """How every case of a batch is run.

    ``steady``: settle until the response repeats within ``tolerance`` (of input amplitude and velocity),
    for at most ``max_periods``; else each case has its own number of settling periods.
    ``continuation``: a case starts where the one before it ended, unless that failed.
    """

    periods: int
    samples_per_period: int
    steady: bool
    tolerance: float
    max_periods: int
    continuation: bool = False


class Batch(NamedTuple):
    """Results of a batch, one row per case; ``waveforms`` without rows: none are kept.

    ``numbers`` (n,) is of ``response.NUMBERS``; ``spectra`` (n, 2, harmonics, 2), ``waveforms`` (n, 5,
    samples): displacement from rest, velocity, both normal forces, sticks; ``outcome``, ``time`` (s)
    reached, ``period``, ``settled`` (periods) (n,); ``statistics`` (n, 3); ``state`` (n, states) at the
    end.
    """

    numbers: Any
    spectra: Any
    waveforms: Any
    outcome: Any
    time: Any
    period: Any
    settled: Any
    statistics: Any
    state: Any


def empty_batch(cases: int, harmonics: int, samples: int) -> Batch:
    """Room for a batch; ``samples`` = 0 keeps no waveforms."""
    numbers = np.empty(cases, response.NUMBERS)
    for name in response.NUMBERS.names or ():
        numbers[name] = np.nan
    return Batch(
        numbers,
        np.full((cases, 2, harmonics, 2), np.nan),
        np.full((cases if samples else 0, 5, samples), np.nan),
        np.zeros(cases, np.int64),
        np.zeros(cases),
        np.zeros(cases, np.int64),
        np.zeros(cases, np.int64),
        np.zeros((cases, 3), np.int64),
        np.zeros((cases, state_count())),
    )


def run_batch(
    parameters: np.ndarray, settle_periods: np.ndarray, settings: BatchSettings, rtol: float, batch: Batch
) -> None:
    """Run all cases of a batch, from rest or in a continuation, into ``batch``."""
    room = memory(
        rtol,
        settings.samples_per_period,
        settings.periods + LONGEST_PERIOD,
        forces=bool(batch.waveforms.size),
    )
    cases = prepared(compact(parameters))
    # One of two loops: code of the other one need not be compiled.
    if settings.steady:
        _run_to_steady_state(cases, parameters, settle_pointer(cases, room), settings, room, batch)
    else:
        _run_given_periods(cases, parameters, settle_periods, settings, room, batch)


@allocating
def _started(cases, i, settings, room, batch):
    """Search and start of a case, and the period of the response that lies close to it (0: unknown)."""
    # The kept periods are run after the search.
    search = shooting(cases, i, (settings.tolerance, settings.max_periods), room, False)
    y, near = np.zeros(search.size.size), 0
    if settings.continuation and i > 0 and batch.outcome[i - 1] == OK:
        copy(batch.state[i - 1], y)
        near = batch.period[i - 1]
    room.work.counts[:] = 0
    room.reached[0] = 0.0
    return search, y, near


@allocating
def _keep(i, y, found, parameters, settings, search, batch):
    """Run the kept periods of a case from y on and write its results.

    ``found``: outcome so far, period of the response in periods of the input (-1: not known), periods run.
    """
    outcome, period, settled = found
    room = search.memory
    batch.period[i], batch.settled[i] = period, settled
    # A response of a longer period is kept for whole periods of its own.
    periods = max(period, 1) * ((settings.periods - 1) // max(period, 1) + 1)
    if outcome == OK:
        clear(room.sums)
        outcome = run_map(settled, periods, y, True, search)
    batch.outcome[i], batch.time[i] = outcome, room.reached[0]
    copy(y, batch.state[i, : y.size])
    copy(room.work.counts, batch.statistics[i])
    if outcome == OK:
        _reduce(i, parameters[i], periods, room, batch)


@compiled
def _run_given_periods(cases, parameters, settle_periods, settings, room, batch):
    """Each case settles for its own number of periods."""
    room, batch = borrowed(room), borrowed(batch)
    for i in range(parameters.size):
        search, y, _ = _started(cases, i, settings, room, batch)
        outcome = OK
        if settle_periods[i] > 0:
            outcome = run_map(0, settle_periods[i], y, False, search)
        _keep(i, y, (outcome, -1, settle_periods[i]), parameters, settings, search, batch)


@compiled
def _run_to_steady_state(cases, parameters, settle, settings, room, batch):
    """Each case settles until its response repeats."""
    room, batch = borrowed(room), borrowed(batch)
    for i in range(parameters.size):
        search, y, near = _started(cases, i, settings, room, batch)
        unknown = np.empty((y.size, y.size))
        unknown[:] = np.nan
        found = settle(y, near, unknown, search)
        _keep(i, y, (found.outcome, found.period, found.run), parameters, settings, search, batch)


@allocating
def _reduce(i, p, periods, room, batch):
    """Write the results of the kept periods of a case."""
    n = periods * room.samples_per_period
    x, velocity = room.x[:n], room.velocity[:n]
    response.reduce(room.sums[0], x, velocity, periods, p, batch.numbers[i], batch.spectra[i])
    if batch.waveforms.shape[0]:
        out = batch.waveforms[i]
        first = n - out.shape[1]
        seen = response.channels(x, velocity, periods, p)
        for k in range(out.shape[1]):
            out[0, k], out[1, k] = seen[0][first + k], seen[1][first + k]
            out[2, k], out[3, k] = room.normal[0, first + k], room.normal[1, first + k]
            out[4, k] = 1.0 if room.sticks[first + k] else 0.0
