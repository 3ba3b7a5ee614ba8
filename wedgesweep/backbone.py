"""Backbone of a free decay: frequency and damping ratio over amplitude, by two methods.

Both methods give the phase and the logarithm of the amplitude at a series of times; their slopes in a
sliding window are the frequency and the rate of decay. Turning points give the two at each swing; the
analytic signal gives them at each sample (Feldman, Hilbert Transform Applications in Mechanical Vibration,
2011). Noise of the record, taken as white, is passed on to first order.
"""

from typing import NamedTuple

import numpy as np
from scipy.signal import find_peaks, hilbert

# Swings end where their half length falls below CLEAR standard deviations of the noise (phases are then known
# to 0.2 rad), or below this share of the largest.
CLEAR, FAINT = 5.0, 0.01
# A parabola is fitted to the samples within this share of a cycle of a turning point: there it departs from a
# cosine by 0.3 % of the amplitude at most, alike at all turning points.
NEAR = 1.0 / 12.0
# Rounds in which a parabola is centred on its vertex: a highest sample may lie beside it by noise.
ROUNDS = 3
# Share by which the amplitude falls within a window, which is at least one cycle long: so curves keep their
# shape.
FALL = 0.2
# Longest window over the length of the decay: of a motion that hardly decays, some points are left.
LONGEST = 0.25
# Share of the window that must lie inside, as the cycles of a record differ.
ALMOST = 0.8
# Cycles at both ends of the record whose analytic signal is not used.
ENDS = 0.5
# Order of the differences that hold the noise and little of the motion, and the sum of their squared weights.
ORDER, SQUARES = 4, 70.0
# Standard deviation over median magnitude of normal numbers.
OVER_MEDIAN = 1.4826


class Backbone(NamedTuple):
    """Estimates along a decay and their standard deviations, each of shape (n,).

    ``amplitude`` is in the unit of the signal, ``frequency`` (Hz) that of the damped oscillation, and
    ``damping`` the damping ratio of a viscous damper with the same decrement.
    """

    amplitude: np.ndarray
    frequency: np.ndarray
    damping: np.ndarray
    frequency_std: np.ndarray
    damping_std: np.ndarray


class Turns(NamedTuple):
    """Turning points from the largest swing on: times (s), values, and their standard deviations, (n,)."""

    time: np.ndarray
    value: np.ndarray
    time_std: float | np.ndarray
    value_std: float

    @property
    def period(self) -> float:
        """Mean time (s) of a cycle."""
        return float(2.0 * (self.time[-1] - self.time[0]) / (self.time.size - 1))

    @property
    def zero(self) -> float:
        """Value about which the signal swings."""
        return float(np.median(self.value[:-2] + 2.0 * self.value[1:-1] + self.value[2:]) / 4.0)


def noise_std(signal: np.ndarray) -> float:
    """Standard deviation of the white noise of a signal (n,) and of its rounding, from its differences."""
    steps = np.abs(np.diff(signal))
    rounding = float(np.min(steps[steps > 0.0], initial=np.ptp(signal)) / np.sqrt(12.0))
    white = OVER_MEDIAN * float(np.median(np.abs(np.diff(signal, ORDER)))) / np.sqrt(SQUARES)
    return float(np.hypot(white, rounding))


def turning_points(time: np.ndarray, signal: np.ndarray, noise: float) -> Turns:
    """Find the turning points of a signal (n,) over an even time (s), from the largest swing on.

    Raises ValueError if there are fewer than three.
    """
    clear = 2.0 * max(CLEAR * noise, 0.5 * FAINT * float(np.ptp(signal)))
    places = np.sort(np.r_[find_peaks(signal, prominence=clear)[0], find_peaks(-signal, prominence=clear)[0]])
    step = float(time[1] - time[0])
    if places.size > 1:
        half = max(1, round(2.0 * NEAR * float(np.median(np.diff(places)))))
        places = places[(places >= half) & (places < signal.size - half)]
    if places.size > 1:
        places = places[int(np.argmax(np.abs(np.diff(signal[places])))) :]
    if places.size < 3:
        raise ValueError(
            f"has {places.size} turning points that stand out of the noise; a backbone needs three"
        )
    offsets = np.arange(-half, half + 1)
    solve = np.linalg.pinv(np.vander(offsets, 3, increasing=True))
    std = noise * np.linalg.norm(solve, axis=1)
    late = np.zeros(places.size)
    for _ in range(ROUNDS):
        places = np.clip(places + np.rint(late).astype(int), half, signal.size - half - 1)
        c = solve @ signal[places[:, None] + offsets].T
        # Rounding may leave a turning point flat: its time is then known to the width of the parabola.
        late = np.clip(-0.5 * c[1] / np.where(c[2] == 0.0, np.inf, c[2]), -half, half)
    time_std = np.minimum(0.5 * std[1] / np.maximum(np.abs(c[2]), 1e-300), half)
    return Turns(time[places] + step * late, c[0] + 0.5 * c[1] * late, step * time_std, float(std[0]))


def from_turning_points(turns: Turns) -> Backbone:
    """Backbone from the swings between turning points, at those that have a whole window around them."""
    time, size = _swings(turns)
    half = 0.5 * _windows(turns)
    inside = _within(turns, ALMOST * half)
    level, slope = _regression(turns.time[inside], time, half[inside])
    # Each swing depends on two turning points, which have errors of their own.
    mean = 0.5 * (np.eye(time.size, time.size + 1) + np.eye(time.size, time.size + 1, 1))
    of_values = slope @ (mean * turns.value_std / size[:, None])
    of_times = 2.0 * np.pi / turns.period * (slope @ (mean * turns.time_std))
    rate, omega = -slope @ np.log(size), np.pi * (slope @ np.arange(time.size))
    error = np.linalg.norm(of_times, axis=1), np.linalg.norm(of_values, axis=1)
    return _backbone(level @ np.log(size), rate, omega, *error)


def from_analytic_signal(time: np.ndarray, signal: np.ndarray, noise: float, turns: Turns) -> Backbone:
    """Backbone of a signal (n,) over an even time (s) from its analytic signal, at the turning points.

    The record from the first to the last turning point, without its zero, is continued at both by its mirror
    image, and so has no jump. ENDS and half a window are left out there. May be empty.
    """
    inside = (time >= turns.time[0]) & (time <= turns.time[-1])
    at, x = time[inside], signal[inside] - turns.zero
    analytic = hilbert(np.r_[x, x[-2:0:-1]])[: x.size]
    phase, size = np.unwrap(np.angle(analytic)), np.abs(analytic)
    half = _windows(turns)
    inside = _within(turns, half + ENDS * turns.period)
    found = [
        _analytic(*each, at, phase, np.log(size), noise)
        for each in zip(turns.time[inside], half[inside], strict=True)
    ]
    return _backbone(*np.array(found).reshape(-1, 5).T)


def _analytic(
    place: float, half: float, time: np.ndarray, phase: np.ndarray, size: np.ndarray, noise: float
) -> tuple[float, ...]:
    """Logarithm of the amplitude, its rate of decay, the circular frequency, and errors of both."""
    near = np.abs(time - place) < half
    level, slope = (each[0] for each in _regression(np.array([place]), time[near], np.array([half])))
    mean = float(level @ size[near])
    # The analytic signal has noise of half the frequencies and four times their power in two components.
    error = float(np.sqrt(2.0) * noise * np.linalg.norm(slope) / np.exp(mean))
    return mean, -float(slope @ size[near]), float(slope @ phase[near]), error, error


def _within(turns: Turns, margin: np.ndarray) -> np.ndarray:
    """Whether turning points are at least a margin (n,) in s away from the first and the last one."""
    return (turns.time >= turns.time[0] + margin) & (turns.time <= turns.time[-1] - margin)


def _swings(turns: Turns) -> tuple[np.ndarray, np.ndarray]:
    """Middle times (s) and half lengths of the swings, shape (n - 1,); no zero of the signal counts."""
    return 0.5 * (turns.time[1:] + turns.time[:-1]), 0.5 * np.abs(np.diff(turns.value))


def _windows(turns: Turns) -> np.ndarray:
    """Length (n,) in s of the window of each turning point: a cycle, or the time of a fall by FALL."""
    time, size = _swings(turns)
    fallen = -np.minimum.accumulate(np.log(size))
    level = np.interp(turns.time, time, fallen)
    falls = np.interp(level + 0.5 * FALL, fallen, time) - np.interp(level - 0.5 * FALL, fallen, time)
    return np.maximum(turns.period, np.minimum(falls, LONGEST * (time[-1] - time[0])))


def _regression(places: np.ndarray, time: np.ndarray, half: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights that give level and slope at places (m,) of values at times (n,), shape (m, n) each.

    Straight lines are fitted under Hann windows of half lengths (m,) in s.
    """
    away = time - places[:, None]
    share = np.minimum(np.abs(away) / half[:, None], 1.0)
    window = 1.0 + np.cos(np.pi * share)
    window /= window.sum(axis=1, keepdims=True)
    middle = (window * away).sum(axis=1, keepdims=True)
    slope = window * (away - middle)
    slope /= (slope * away).sum(axis=1, keepdims=True)
    return window - middle * slope, slope


def _backbone(
    level: np.ndarray, rate: np.ndarray, omega: np.ndarray, omega_std: np.ndarray, rate_std: np.ndarray
) -> Backbone:
    turn, damping = 2.0 * np.pi, rate / np.hypot(rate, omega)
    return Backbone(np.exp(level), omega / turn, damping, omega_std / turn, rate_std / omega)
