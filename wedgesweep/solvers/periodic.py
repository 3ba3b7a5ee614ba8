"""Steady responses of many cases, each started from a state nearby: what a fit asks for.

Works alike for the base model, whose states are the first two of the extended system's, and for every
effect. See settling.py for the way to a steady state.
"""

from collections.abc import Sequence
from math import ceil, pi
from typing import Any, NamedTuple

import numpy as np

from wedgesweep import response, sensor
from wedgesweep.compiled import compiled
from wedgesweep.extended.mode import SIZE
from wedgesweep.solvers.march import OK
from wedgesweep.solvers.passage import clear, passage, tools
from wedgesweep.solvers.repetition import LONGEST
from wedgesweep.solvers.settling import settle

__all__ = ["OK", "SIZE", "Periodic", "Warm", "at_rest", "joined", "respond", "samples"]

# Time constants after which the lag of the velocity channel has forgotten how it began.
LAG_TIMES = 16.0


class Warm(NamedTuple):
    """Where steady responses were found, a row a case, and so where to look for those of their neighbours.

    ``state`` (n, SIZE) at phase 0 (NaN: nowhere; start at rest), ``period`` (n,) of the response in forcing
    periods (0: it does not repeat), ``map`` (n, SIZE, SIZE) the derivative of the state a period later by
    that at phase 0 (NaN: unknown).
    """

    state: Any
    period: Any
    map: Any

    def repeated(self, times: int) -> "Warm":
        """All rows so many times, one after the other."""
        return Warm(*(np.concatenate([each] * times) for each in self))

    def of(self, rows: Any) -> "Warm":
        """Some of the rows."""
        return Warm(*(each[rows] for each in self))

    def where(self, chosen: np.ndarray, other: "Warm") -> "Warm":
        """Rows from another where they are chosen (n,), else the own ones."""
        found = Warm(*(each.copy() for each in self))
        for mine, its in zip(found, other, strict=True):
            mine[chosen] = its[chosen]
        return found


def at_rest(cases: int) -> Warm:
    """No neighbour."""
    return Warm(
        np.full((cases, SIZE), np.nan), np.zeros(cases, np.int64), np.full((cases, SIZE, SIZE), np.nan)
    )


def joined(some: Sequence[Warm]) -> Warm:
    """Rows of all, one after the other."""
    return Warm(*map(np.concatenate, zip(*some, strict=True)))


class Periodic(NamedTuple):
    """Steady responses, a row a case (SI units); NaN where there is none.

    ``spectra`` (n, 2, H), complex: D_h, h = 1..H, of displacement x - y = -z and of its rate, as the sensors
    show them; ``warm``: where they were found. ``outcome`` (n,) is OK or one of event_driven.MESSAGES;
    ``periods`` run, ``extremes`` (n, 2) lowest and highest deflection (m), ``stuck`` share of time,
    ``lifted`` share of time with a negative normal force (NaN if no forces were asked for).
    """

    spectra: Any
    warm: Warm
    outcome: Any
    periods: Any
    extremes: Any
    stuck: Any
    lifted: Any


def respond(
    parameters: np.ndarray,
    warm: Warm,
    tolerance: float,
    most_periods: int,
    samples_per_period: int,
    harmonics: int,
    rtol: float,
    forces: bool = False,
) -> Periodic:
    """Steady responses of parameter records, shape (n,).

    Parameters
    ----------
    parameters : structured array, shape (n,)
        See parameters.record.
    warm : Warm, n rows
        Where to start from.
    tolerance : float
        Change of the state per repetition, over input amplitude and velocity, that counts as steady.
    most_periods : int
        Periods after which a response counts as not periodic.
    samples_per_period, harmonics : int
        Samples from which the harmonics are taken, and how many.
    rtol : float
        Relative tolerance of a step.
    forces : bool
        Look at the normal forces, too, which takes an extended case twice the time.
    """
    n = len(parameters)
    found = Periodic(
        np.full((n, 2, harmonics), np.nan, np.complex128),
        Warm(*(each.copy() for each in warm)),
        np.zeros(n, np.int64),
        np.zeros(n, np.int64),
        np.full((n, 2), np.nan),
        np.full(n, np.nan),
        np.full(n, np.nan),
    )
    bench = tools(rtol, samples_per_period, forces=forces)
    motion = np.full((n, 2, samples_per_period), np.nan)
    _respond_all(parameters, tolerance, most_periods, bench, found, motion, passage())
    found.spectra[:] = np.fft.rfft(motion)[..., 1 : harmonics + 1] * (2.0 / samples_per_period)
    _sense_all(parameters, found.spectra.view(float).reshape(n, 2, harmonics, 2))
    return found


@compiled
def _respond_all(parameters, tolerance, most, bench, found, motion, passage):
    for i in range(parameters.size):
        case = parameters[i : i + 1]
        y, before = found.warm.state[i].copy(), found.warm.period[i]
        outcome, period, run, kept = settle(
            y, before, found.warm.map[i], case, tolerance, most, bench, passage
        )
        if outcome == OK and not kept:
            # Of a response that does not repeat, the mean over as many periods as there is room for.
            kept = period if period else LONGEST
            clear(bench.tally)
            outcome = passage(run if period == 0 else 0, kept, y, case, True, bench)
            run += kept
        found.outcome[i], found.periods[i] = outcome, run
        found.warm.state[i], found.warm.period[i] = y, period
        if outcome != OK:
            found.warm.state[i] = np.nan
        else:
            _reduce(i, kept, bench, found, motion[i])


@compiled
def _reduce(i, periods, bench, found, motion):
    """Write what the kept periods come to; ``motion`` (2, samples): displacement x - y and its rate."""
    n = periods * bench.samples_per_period
    response.mean_period(-bench.x[:n], motion[0])
    response.mean_period(-bench.velocity[:n], motion[1])
    one = bench.tally[0]
    found.extremes[i, 0], found.extremes[i, 1] = one.lowest, one.highest
    found.stuck[i] = one.stuck_time / one.time
    if bench.normal.shape[1] > 0:
        found.lifted[i] = one.lifted_time / one.time


@compiled
def _sense_all(parameters, spectra):
    for i in range(parameters.size):
        sensor.apply_to_spectra(spectra[i], parameters[i])


def samples(
    parameters: np.ndarray,
    states: np.ndarray,
    settle_periods: int,
    periods: int,
    samples_per_period: int,
    rtol: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Deflection (m) and velocity (m/s) as the sensors show them, shape (n, samples), and states at the end.

    For responses that do not repeat: each case starts at phase 0 from ``states`` (n, SIZE; a row with NaN
    at rest) and runs ``settle_periods`` before the kept ones. NaN where the case has no answer.
    """
    n, kept = len(parameters), periods * samples_per_period
    x, velocity = np.full((n, kept), np.nan), np.full((n, kept), np.nan)
    state = np.array(states, dtype=float)
    slowest = float((parameters["velocity_lag_time"] * parameters["omega"]).max()) / (2.0 * pi)
    # The lag of the velocity channel dies out before the kept samples.
    before = min(settle_periods, ceil(LAG_TIMES * slowest))
    bench = tools(rtol, samples_per_period, before + periods, forces=False)
    _sample_all(parameters, settle_periods - before, before, periods, bench, x, velocity, state, passage())
    return x, velocity, state


@compiled
def _sample_all(parameters, settle_periods, before, periods, bench, x, velocity, state, passage):
    for i in range(parameters.size):
        case = parameters[i : i + 1]
        p = case[0]
        y = state[i].copy() if np.isfinite(state[i]).all() else np.zeros(SIZE)
        outcome = OK
        if settle_periods > 0:
            outcome = passage(0, settle_periods, y, case, False, bench)
        if outcome == OK:
            outcome = passage(settle_periods, before + periods, y, case, True, bench)
        state[i] = y
        if outcome != OK:
            state[i] = np.nan
        else:
            step = 2.0 * pi / p.omega / bench.samples_per_period
            x[i] = p.displacement_gain_scale * bench.x[-x.shape[1] :]
            velocity[i] = sensor.lagged(bench.velocity, step, False, p)[-x.shape[1] :]
