"""Event-driven solver of the extended system, for one case or for many.

What happens between two phases 0 of the input is compiled; the loop over cases is not, as it costs next
to nothing beside them.
"""

import numpy as np

from wedgesweep import response
from wedgesweep.extended.mode import SIZE, VELOCITY, X
from wedgesweep.solvers import settling
from wedgesweep.solvers.march import OK
from wedgesweep.solvers.passage import Tools, clear, passage, run_periods, tools
from wedgesweep.solvers.repetition import LONGEST
from wedgesweep.solvers.trajectory import Samples, Trajectory, Window

STATISTICS = ("rate_evaluations", "steps", "switches")


def run(
    parameters: np.ndarray, window: Window, rtol: float, start: tuple[float, float]
) -> tuple[int, float, Trajectory]:
    """One case from a deflection and its rate: outcome, time reached (s) and what was kept."""
    bench = tools(rtol, window.samples_per_period, window.periods)
    y, settle = np.zeros(SIZE), window.settle_periods
    y[[X, VELOCITY]] = start
    outcome = run_periods(passage(), 0, settle, y, parameters, False, bench)
    if outcome == OK:
        outcome = run_periods(passage(), settle, window.periods, y, parameters, True, bench)
    contact = np.zeros((bench.x.size, 5), np.int8)
    contact[:, 0] = ~bench.sticks
    samples = Samples(window.sample_times, bench.x, bench.velocity, contact, bench.normal)
    counts = dict(zip(STATISTICS, bench.room.counts.tolist(), strict=True))
    return outcome, bench.reached[0], Trajectory(samples, bench.tally, window.periods, counts)


def run_batch(parameters, settle_periods, plan, rtol: float, batch) -> None:
    """As ``event_driven.run_batch``, for records of the extended system."""
    bench = tools(rtol, plan.samples_per_period, plan.periods + LONGEST)
    before = None
    for i in range(len(parameters)):
        y, near = np.zeros(SIZE), 0
        if plan.chain and before is not None:
            y[:], near = before, int(batch.period[i - 1])
        _run_case(i, y, near, parameters[i : i + 1], int(settle_periods[i]), plan, bench, batch)
        before = y if batch.outcome[i] == OK else None
        batch.state[i] = y[[X, VELOCITY]]


def _run_case(
    i: int, y: np.ndarray, near: int, case: np.ndarray, settle: int, plan, bench: Tools, batch
) -> None:
    """Settle, keep and reduce one case; y moves along. ``near``: period of a response close to y, else 0."""
    bench.room.counts[:] = 0
    outcome, period = OK, -1
    bench.reached[0] = 0.0
    if plan.steady:
        unknown = np.full((SIZE, SIZE), np.nan)
        outcome, period, settle, _ = settling.settle(
            y, near, unknown, case, plan.tolerance, plan.most, bench, passage()
        )
    elif settle:
        outcome = run_periods(passage(), 0, settle, y, case, False, bench)
    batch.outcome[i], batch.period[i], batch.settled[i] = outcome, period, settle
    batch.time[i] = bench.reached[0]
    if outcome == OK:
        # A response of a longer period is kept for whole periods of its own.
        periods = max(period, 1) * ((plan.periods - 1) // max(period, 1) + 1)
        clear(bench.tally)
        outcome = run_periods(passage(), settle, periods, y, case, True, bench)
        batch.outcome[i], batch.time[i] = outcome, bench.reached[0]
    batch.statistics[i] = bench.room.counts
    if outcome == OK:
        _reduce(i, case, periods, plan.samples_per_period, bench, batch)


def _reduce(i: int, case: np.ndarray, periods: int, samples_per_period: int, bench: Tools, batch) -> None:
    n = periods * samples_per_period
    x, velocity = bench.x[:n], bench.velocity[:n]
    response.reduce(bench.tally[0], x, velocity, periods, case[0], batch.numbers[i], batch.spectra[i])
    if len(batch.waveforms):
        last = slice(n - batch.waveforms.shape[2], n)
        seen = response.channels(x, velocity, periods, case[0])
        batch.waveforms[i, :2] = np.stack(seen)[:, last]
        batch.waveforms[i, 2:4] = bench.normal[:, last]
        batch.waveforms[i, 4] = bench.sticks[last]
