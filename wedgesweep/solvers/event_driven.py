"""Compiled solver that goes from event to event, for one case or for many.

The same contact states, forces and switches as the Radau solver; only the way from one switch to the
next is another. Many cases run in one compiled loop.
"""

from math import pi
from typing import Any, NamedTuple

import numpy as np

from wedgesweep import contact as contacts
from wedgesweep import response, tally
from wedgesweep.compiled import compiled
from wedgesweep.solvers.march import CHATTERING, OK, SWITCHES_PER_PERIOD, march
from wedgesweep.solvers.recorder import Recorder
from wedgesweep.solvers.runge_kutta import FAILED
from wedgesweep.solvers.steady import LONGEST, settle
from wedgesweep.solvers.sticking import LOCKED
from wedgesweep.solvers.trajectory import CaseError, Samples, Trajectory, Window

MESSAGES = {
    LOCKED: ("locked", "normal forces not unique: the wedge locks"),
    FAILED: ("solver_failure", "the step size became too small"),
    CHATTERING: ("solver_failure", f"more than {SWITCHES_PER_PERIOD} switches per period"),
}
STATISTICS = ("rate_evaluations", "steps", "switches")


@compiled
def follow(parameters, start, keep, end, x, velocity, rtol, recorder, statistics):
    """One case from a state at ``start`` to the end of its window: outcome, time, x and velocity."""
    p = parameters[0]
    contact, unique = contacts.initial(start, x, velocity, p)
    if not unique:
        return LOCKED, start, x, velocity
    h, last = 2.0 * pi / p.omega / 1000.0, -1
    outcome, t, x, velocity, contact, last, h = march(
        start, keep, x, velocity, contact, last, parameters, rtol, h, False, recorder, statistics
    )
    if outcome == OK:
        outcome, t, x, velocity, contact, last, h = march(
            keep, end, x, velocity, contact, last, parameters, rtol, h, True, recorder, statistics
        )
    return outcome, t, x, velocity


def solve(
    parameters: np.ndarray,
    window: Window,
    rtol: float,
    time_limit: float,
    start: tuple[float, float] = (0.0, 0.0),
) -> Trajectory:
    """Run one case; arguments and errors as for ``radau.solve``."""
    times = window.sample_times
    samples = Samples(times, np.empty(times.size), np.empty(times.size), np.empty((times.size, 5), np.int8))
    sums = tally.empty()
    recorder = Recorder(window.keep, times[1] - times[0], sums, samples.x, samples.velocity, samples.contact)
    statistics = np.zeros(3, np.int64)
    outcome, t, _, _ = follow(parameters, 0.0, window.keep, window.end, *start, rtol, recorder, statistics)
    if outcome != OK:
        status, message = MESSAGES[outcome]
        raise CaseError(f"{message} (at t = {t:.6g} s)", status)
    counts = dict(zip(STATISTICS, statistics.tolist(), strict=True))
    return Trajectory(samples, sums, window.periods, counts)


class Plan(NamedTuple):
    """How every case of a batch is run.

    ``steady``: settle until the response repeats within ``tolerance`` (of input amplitude and velocity),
    for at most ``most`` periods; else each case has its own number of settling periods.
    ``chain``: a case starts where the one before it ended, unless that failed.
    """

    periods: int
    samples_per_period: int
    rtol: float
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
def _clear(sums):
    """Empty a tally."""
    one = sums[0]
    one.lowest, one.highest, one.normal_force = np.inf, -np.inf, np.inf
    one.peak_velocity = one.time = one.integral = 0.0
    one.stuck_time = one.lifted_time = one.dissipated = one.supplied = 0.0
    one.onsets = one.began_stuck = one.is_stuck = 0.0


@compiled
def _keep_waveforms(recorder, parameters, out):
    """Write the last samples of a case as waveforms."""
    samples = out.shape[1]
    x, velocity = recorder.x[-samples:], recorder.velocity[-samples:]
    contact = recorder.contact[-samples:]
    times = recorder.start + recorder.step * np.arange(recorder.x.size)[-samples:]
    out[0], out[1] = x, velocity
    response.normal_forces(times, x, velocity, contact, parameters[0], out[2:4])
    for i in range(samples):
        out[4, i] = 1.0 if abs(contact[i, 0]) != 1 else 0.0


@compiled
def run_batch(parameters, settle_periods, starts, plan, sums, batch):
    """Run all cases of a batch, from ``starts`` (n, 2), into ``batch``."""
    longest = plan.periods + LONGEST
    x = np.empty(longest * plan.samples_per_period)
    velocity = np.empty_like(x)
    contact = np.empty((x.size, 5), np.int8)
    for i in range(parameters.size):
        case = parameters[i : i + 1]
        cycle = 2.0 * pi / case[0].omega
        step = cycle / plan.samples_per_period
        start_x, start_velocity = starts[i]
        if plan.chain and i > 0 and batch.outcome[i - 1] == OK:
            start_x, start_velocity = batch.state[i - 1]
        settled, periods, begin = settle_periods[i], plan.periods, 0.0
        if plan.steady:
            nothing = Recorder(0.0, step, sums, x[:0], velocity[:0], contact[:0])
            outcome, settled, start_x, start_velocity, period = settle(
                start_x,
                start_velocity,
                case,
                plan.rtol,
                plan.tolerance,
                plan.most,
                nothing,
                batch.statistics[i],
            )
            batch.outcome[i], batch.period[i] = outcome, period
            begin = settled * cycle
            if period > 1:
                periods = period * ((plan.periods + period - 1) // period)
        batch.settled[i] = settled
        keep = settled * cycle
        batch.time[i] = keep
        if batch.outcome[i] != OK:
            continue
        n = periods * plan.samples_per_period
        _clear(sums)
        recorder = Recorder(keep, step, sums, x[:n], velocity[:n], contact[:n])
        outcome, time, end_x, end_velocity = follow(
            case,
            begin,
            keep,
            (settled + periods) * cycle,
            start_x,
            start_velocity,
            plan.rtol,
            recorder,
            batch.statistics[i],
        )
        batch.outcome[i], batch.time[i] = outcome, time
        batch.state[i, 0], batch.state[i, 1] = end_x, end_velocity
        if outcome != OK:
            continue
        response.reduce(sums[0], x[:n], velocity[:n], periods, case[0], batch.numbers[i], batch.spectra[i])
        if batch.waveforms.shape[0]:
            _keep_waveforms(recorder, case, batch.waveforms[i])
