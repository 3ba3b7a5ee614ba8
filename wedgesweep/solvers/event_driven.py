"""Compiled solver that goes from event to event, for one case or for many.

The same contact states, forces and switches as the Radau solver; only the way from one switch to the
next is another. Many cases run in one compiled loop.
"""

from math import pi
from typing import Any, NamedTuple

import numpy as np

from wedgesweep import response, tally
from wedgesweep.compiled import borrowed, compiled
from wedgesweep.solvers import extended
from wedgesweep.solvers.extended import STATISTICS
from wedgesweep.solvers.march import CHATTERING, OK, SWITCHES_PER_PERIOD, begin, march, workspace
from wedgesweep.solvers.passage import clear
from wedgesweep.solvers.recorder import Recorder
from wedgesweep.solvers.repetition import LONGEST
from wedgesweep.solvers.runge_kutta import FAILED
from wedgesweep.solvers.steady import settle
from wedgesweep.solvers.sticking import LOCKED
from wedgesweep.solvers.trajectory import CaseError, TimedWindow, Trajectory, Window, empty_samples

MESSAGES = {
    LOCKED: ("locked", "normal forces not unique: the wedge locks"),
    FAILED: ("solver_failure", "the steps became too small, or too many"),
    CHATTERING: ("solver_failure", f"more than {SWITCHES_PER_PERIOD} switches per period"),
}


@compiled
def follow(state, keep, end, parameters, recorder, work):
    """One case from a state to the end of its window: the outcome and the state reached."""
    outcome, state = march(state, keep, parameters, False, recorder, work)
    if outcome == OK:
        outcome, state = march(state, end, parameters, True, recorder, work)
    return outcome, state


@compiled
def follow_from(t, x, velocity, keep, end, parameters, recorder, work):
    """``follow`` from a time, deflection and velocity."""
    state, unique = begin(t, x, velocity, parameters[0])
    if not unique:
        return LOCKED, state
    return follow(state, keep, end, parameters, recorder, work)


def solve(
    parameters: np.ndarray,
    window: Window,
    rtol: float,
    time_limit: float,
    start: tuple[float, float] = (0.0, 0.0),
) -> Trajectory:
    """Run one case; arguments and errors as for ``radau.solve``.

    The compiled loop cannot be interrupted: in place of the time limit it counts steps and switches. It
    samples even phases only: a TimedWindow is a TypeError.
    """
    if isinstance(window, TimedWindow):
        message = "sample times of one's own are for radau.solve; this solver samples even phases"
        raise TypeError(message)
    if parameters["extended"][0]:
        outcome, time, run = extended.run(parameters, window, rtol, start)
        _require(outcome, time)
        return run
    times = window.sample_times
    samples = empty_samples(times)
    sums, work = tally.empty(), workspace(rtol)
    recorder = Recorder(window.keep, times[1] - times[0], sums, samples.x, samples.velocity, samples.contact)
    outcome, state = follow_from(0.0, *start, window.keep, window.end, parameters, recorder, work)
    _require(outcome, state.t)
    response.normal_forces(times, samples.x, samples.velocity, samples.contact, parameters[0], samples.normal)
    counts = dict(zip(STATISTICS, work.counts.tolist(), strict=True))
    return Trajectory(samples, sums, window.periods, counts)


def _require(outcome: int, time: float) -> None:
    if outcome != OK:
        status, message = MESSAGES[outcome]
        message = f"{message} (at t = {time:.6g} s)"
        raise CaseError(message, status)


class Plan(NamedTuple):
    """How every case of a batch is run.

    ``steady``: settle until the response repeats within ``tolerance`` (of input amplitude and velocity),
    for at most ``most`` periods; else each case has its own number of settling periods.
    ``chain``: a case starts where the one before it ended, unless that failed.
    """

    periods: int
    samples_per_period: int
    steady: bool
    tolerance: float
    most: int
    chain: bool = False


class Batch(NamedTuple):
    """What a batch comes to, a row a case; ``waveforms`` may have no rows, and then none are kept.

    ``numbers`` (n, len(response.NUMBERS)), ``spectra`` (n, 2, harmonics, 2), ``waveforms`` (n, 5, samples):
    x, velocity, normal force on column and bolster, stuck; ``outcome``, ``time`` (s) reached, ``period``,
    ``settled`` (periods) (n,); ``statistics`` (n, 3); ``state`` (n, 2) at the end.
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
    return Batch(
        np.full((cases, len(response.NUMBERS)), np.nan),
        np.full((cases, 2, harmonics, 2), np.nan),
        np.full((cases if samples else 0, 5, samples), np.nan),
        np.zeros(cases, np.int64),
        np.zeros(cases),
        np.zeros(cases, np.int64),
        np.zeros(cases, np.int64),
        np.zeros((cases, 3), np.int64),
        np.zeros((cases, 2)),
    )


@compiled
def _keep_waveforms(recorder, periods, parameters, out):
    """Write the last samples of a case as waveforms."""
    samples = out.shape[1]
    x, velocity = recorder.x[-samples:], recorder.velocity[-samples:]
    contact = recorder.contact[-samples:]
    times = recorder.start + recorder.step * np.arange(recorder.x.size)[-samples:]
    seen = response.channels(recorder.x, recorder.velocity, periods, parameters[0])
    out[0], out[1] = seen[0][-samples:], seen[1][-samples:]
    response.normal_forces(times, x, velocity, contact, parameters[0], out[2:4])
    for i in range(samples):
        out[4, i] = 1.0 if abs(contact[i, 0]) != 1 else 0.0


@compiled
def _settled(start, settle_periods, case, plan, sums, work):
    """Where a case's window may begin: outcome, settled periods, start of ``follow``, period, state."""
    if not plan.steady:
        return OK, settle_periods, 0.0, -1, start[0], start[1]
    empty = np.empty(0)
    nothing = Recorder(0.0, 1.0, sums, empty, empty, np.empty((0, 5), np.int8))
    outcome, settled, x, velocity, period = settle(
        start[0], start[1], case, plan.tolerance, plan.most, nothing, work
    )
    return outcome, settled, settled * 2.0 * pi / case[0].omega, period, x, velocity


@compiled
def run_batch(parameters, settle_periods, plan, sums, work, batch):
    """Run all cases of a batch, from rest or in a chain, into ``batch``."""
    sums, work, batch = borrowed(sums), borrowed(work), borrowed(batch)
    longest = plan.periods + LONGEST
    x = np.empty(longest * plan.samples_per_period)
    velocity = np.empty_like(x)
    contact = np.empty((x.size, 5), np.int8)
    for i in range(parameters.size):
        case = parameters[i : i + 1]
        cycle = 2.0 * pi / case[0].omega
        start = (0.0, 0.0)
        if plan.chain and i > 0 and batch.outcome[i - 1] == OK:
            start = (batch.state[i - 1, 0], batch.state[i - 1, 1])
        work.counts[:] = 0
        outcome, settled, first, period, x0, v0 = _settled(start, settle_periods[i], case, plan, sums, work)
        batch.outcome[i], batch.period[i], batch.settled[i] = outcome, period, settled
        batch.time[i] = settled * cycle
        if outcome == OK:
            # A response of a longer period is kept for whole periods of its own.
            periods = max(period, 1) * ((plan.periods - 1) // max(period, 1) + 1)
            n = periods * plan.samples_per_period
            keep, end = settled * cycle, (settled + periods) * cycle
            clear(sums)
            step = cycle / plan.samples_per_period
            recorder = borrowed(Recorder(keep, step, sums, x[:n], velocity[:n], contact[:n]))
            outcome, state = follow_from(first, x0, v0, keep, end, case, recorder, work)
            batch.outcome[i], batch.time[i] = outcome, state.t
            batch.state[i, 0], batch.state[i, 1] = state.x, state.velocity
        batch.statistics[i] = work.counts
        if outcome == OK:
            response.reduce(
                sums[0], x[:n], velocity[:n], periods, case[0], batch.numbers[i], batch.spectra[i]
            )
            if batch.waveforms.shape[0]:
                _keep_waveforms(recorder, periods, case, batch.waveforms[i])
