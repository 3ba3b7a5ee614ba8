"""Steady motion of the true system at given times, as the sensors give it without noise."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil, exp, pi

import numpy as np

from wedgesweep.solvers import radau
from wedgesweep.solvers.trajectory import TimedWindow

RTOL = 1e-8
# Settling ends when a period changes the state by less than this share of the input.
SETTLED = 1e-6
TIME_LIMIT = 600.0
# The lag of the velocity channel is integrated in such steps, starting this many time constants before.
LAG_STEPS_PER_PERIOD = 4000
LAG_MEMORY = 25.0


@dataclass(frozen=True)
class Clock:
    """Sample times: from ``start`` (s after a zero crossing of the input), ``step`` (s) apart."""

    start: float
    step: float
    count: int


@dataclass(frozen=True, eq=False)
class Motion:
    """Displacement x - y (m, less that of the rest) and its rate (m/s), shape (n,)."""

    displacement: np.ndarray
    velocity: np.ndarray
    settle_periods: int


def steady(
    record: np.ndarray,
    clock: Clock,
    settle_periods: int,
    repeats: bool,
    effects: Mapping[str, Mapping[str, float]],
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

    Raises
    ------
    CaseError
        If the wedge locks or the solver fails.
    """
    period = 2.0 * pi / float(record["input"]["omega"][0])
    lag = effects.get("velocity_lag", {}).get("time", 0.0)
    finer = ceil(clock.step / period * LAG_STEPS_PER_PERIOD) if lag > 0.0 else 1
    ahead = ceil(LAG_MEMORY * lag / clock.step) * finer
    fine = clock.step / finer
    # Shifted by whole periods, so that the window also covers the times before the first sample.
    shift = period * ceil(ahead * fine / period)
    offsets = shift + clock.start + fine * np.arange(-ahead, (clock.count - 1) * finer + 1)
    window = TimedWindow(2.0 * pi / period, settle_periods, ceil(offsets[-1] / period) + 1, 0, offsets)
    samples = radau.solve(record, window, RTOL, TIME_LIMIT, settled=SETTLED if repeats else None).samples
    velocity = _lagged(-samples.velocity, fine, lag) if lag > 0.0 else -samples.velocity
    gain = effects.get("displacement_gain", {}).get("scale", 1.0)
    settled = round((samples.t[0] - offsets[0]) / period)
    return Motion(-gain * samples.x[ahead::finer], velocity[ahead::finer], settled)


def _lagged(signal: np.ndarray, step: float, lag: float) -> np.ndarray:
    """First-order lag (s), lag y' = signal - y, exact for a signal that is linear between its samples."""
    from scipy.signal import lfilter

    decay = exp(-step / lag)
    straight = lag / step * (1.0 - decay)
    return lfilter([1.0 - straight, straight - decay], [1.0, -decay], signal - signal[0]) + signal[0]
