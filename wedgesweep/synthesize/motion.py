"""Steady motion of the true system at given times, as the sensors give it without noise.

Radau alone makes the data. The event-driven solver, which is much faster, only says where settling begins;
once Radau's own motion repeats, one period of it is a whole record.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, exp, pi

import numpy as np

from wedgesweep.solvers import periodic, radau
from wedgesweep.solvers.period_map import count_states
from wedgesweep.solvers.trajectory import TimedWindow
from wedgesweep.systems import compact

RTOL = 1e-8
# Settling ends when a period changes the state by less than this share of the input.
SETTLED = 1e-6
TIME_LIMIT = 600.0
# How the event-driven solver looks for it.
STEADY = periodic.Accuracy(1e-7, 100, rtol=1e-7)
# From there Radau's motion repeats after a few periods, or it is run from rest.
SOON = 40
# The lag of the velocity channel is integrated in such steps, starting this many time constants before.
LAG_STEPS_PER_PERIOD = 4000
LAG_MEMORY = 25.0
# Samples of the load per period, of which the harmonics that pass the filter are taken: it jumps where slip
# turns.
LOAD_SAMPLES = 2**14


class NoMotion(Exception):
    """A test to which the true system has no answer: a wedge locks, or a face lifts off."""


@dataclass(frozen=True)
class Clock:
    """Sample times: from ``start`` (s after a zero crossing of the input), ``step`` (s) apart."""

    start: float
    step: float
    count: int


@dataclass(frozen=True, eq=False)
class Motion:
    """Displacement x - y (m, less that of the rest) and its rate (m/s), shape (n,).

    ``load`` (n,): normal force of the column (N), low-passed as a load cell's amplifier does it; None if it
    was not asked for.
    """

    displacement: np.ndarray
    velocity: np.ndarray
    settle_periods: int
    load: np.ndarray | None = None


def steady(
    record: np.ndarray,
    clock: Clock,
    settle_periods: int,
    repeats: bool,
    effects: Mapping[str, Mapping[str, float]],
    load: bool = False,
) -> Motion:
    """Simulate a test until it is steady, and sample it as the sensors do.

    Parameters
    ----------
    record : structured array, shape (1,)
        See systems.suspension.parameters.record.
    clock : Clock
        When to sample.
    settle_periods : int
        Number of periods after which the motion counts as steady at the latest.
    repeats : bool
        Whether the motion can be periodic; otherwise all settling periods are run.
    effects : mapping
        Effects of the config in SI units; velocity_lag and displacement_gain are applied here.
    load : bool
        Whether the load of the column is recorded.

    Raises
    ------
    CaseError
        If the wedge locks or the solver fails.
    NoMotion
        If the load is wanted and not determined.
    """
    period = 2.0 * pi / float(record["input"]["omega"][0])
    lag = effects.get("velocity_lag", {}).get("time", 0.0)
    finer = lag_steps(clock.step, period, lag)
    ahead = ceil(LAG_MEMORY * lag / clock.step) * finer
    fine = clock.step / finer
    # Shifted by whole periods, so that the window also covers the times before the first sample.
    shift = period * ceil(ahead * fine / period)
    offsets = shift + clock.start + fine * np.arange(-ahead, (clock.count - 1) * finer + 1)
    x, velocity, _, settled = _sampled(record, offsets, settle_periods, repeats)
    seen = lagged(-velocity, fine, lag) if lag > 0.0 else -velocity
    gain = effects.get("displacement_gain", {}).get("scale", 1.0)
    found = _load(record, clock, settle_periods) if load else None
    return Motion(-gain * x[ahead::finer], seen[ahead::finer], settled, found)


def _load(record: np.ndarray, clock: Clock, settle_periods: int) -> np.ndarray:
    """Normal force (N) of the column at the times of a clock (n,), low-passed at half the sampling rate."""
    period = 2.0 * pi / float(record["input"]["omega"][0])
    _, _, force, _ = _sampled(record, period / LOAD_SAMPLES * np.arange(LOAD_SAMPLES), settle_periods, True)
    if np.isnan(force).any():
        raise NoMotion(
            "friction holds the bolster at times, and no normal force is determined; raise the amplitude"
        )
    passed = int(0.5 * period / clock.step)
    harmonics = np.fft.rfft(force)[: passed + 1] * (2.0 / LOAD_SAMPLES)
    phase = (
        2.0 * pi * np.outer(np.arange(passed + 1), clock.start + clock.step * np.arange(clock.count)) / period
    )
    return (harmonics @ np.exp(1j * phase)).real - 0.5 * harmonics[0].real


def _sampled(
    record: np.ndarray, offsets: np.ndarray, settle_periods: int, repeats: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """Deflection (m), its rate and normal force (N) at times (s) after settling, and periods that it took."""
    omega = float(record["input"]["omega"][0])
    period = 2.0 * pi / omega
    soon = min(settle_periods, SOON)
    if repeats:
        places = offsets % period
        order = np.argsort(places)
        window = TimedWindow(omega, soon, 1, 0, places[order])
        start = _steady_state(record)
        found = radau.solve(record, window, RTOL, TIME_LIMIT, start, SETTLED).samples
        settled = round((found.t[0] - places[order[0]]) / period)
        if settled < soon:
            back = np.argsort(order)
            return found.x[back], found.velocity[back], found.normal[0][back], settled
    window = TimedWindow(omega, settle_periods, ceil(offsets[-1] / period) + 1, 0, offsets)
    found = radau.solve(record, window, RTOL, TIME_LIMIT, settled=SETTLED if repeats else None).samples
    return found.x, found.velocity, found.normal[0], round((found.t[0] - offsets[0]) / period)


def _steady_state(record: np.ndarray) -> Sequence[float]:
    """States from which settling is short; at rest where none are found."""
    found = periodic.respond(record, periodic.at_rest(1), STEADY, 64, 1)
    if found.outcome[0] != periodic.OK or found.warm.period[0] != 1:
        return (0.0, 0.0)
    return found.warm.state[0, : count_states(compact(record))].tolist()


def sines(waves: Iterable[tuple[float, float, float]], time: np.ndarray, order: int) -> np.ndarray:
    """A derivative, at times (n,) in s, of a sum of sines: amplitude, angular frequency (rad/s) and phase.

    Each derivative multiplies by the frequency and advances the phase by a quarter of a turn.
    """
    parts = [
        size * rate**order * np.sin(rate * time + phase + 0.5 * pi * order) for size, rate, phase in waves
    ]
    return np.sum(parts, axis=0)


def lag_steps(step: float, period: float, lag: float) -> int:
    """Steps of a sample (s) in which a lag (s) is integrated, beside a motion with a period (s)."""
    return ceil(step / period * LAG_STEPS_PER_PERIOD) if lag > 0.0 else 1


def lagged(signal: np.ndarray, step: float, lag: float) -> np.ndarray:
    """First-order lag (s), lag y' = signal - y, exact for a signal that is linear between its samples."""
    from scipy.signal import lfilter

    decay = exp(-step / lag)
    straight = lag / step * (1.0 - decay)
    return lfilter([1.0 - straight, straight - decay], [1.0, -decay], signal - signal[0]) + signal[0]
