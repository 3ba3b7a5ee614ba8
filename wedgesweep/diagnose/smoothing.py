"""Velocity and acceleration from a recorded displacement, and the noise that this leaves.

Displacement, measured force and simulated force pass the same zero-phase filter (Butterworth, forward and
backward), so that no signal is delayed against another. The variance of the acceleration's noise rises with
the fifth power of the cut-off frequency, which therefore has an upper limit (``highest_cutoff``).
"""

from dataclasses import dataclass
from functools import cached_property
from math import inf, pi

import numpy as np
from scipy import signal
from scipy.interpolate import make_interp_spline
from scipy.ndimage import median_filter
from scipy.optimize import brentq
from scipy.special import ndtri

from wedgesweep.measured.kinds import HIGHEST
from wedgesweep.periodogram import power_of

ORDER = 4
# Noise of the displacement makes up at most this share of the force, by inertia, and of the velocity; the
# cut-off is the highest one at which that holds, between LOWEST and HIGHEST of the sampling rate.
NOISE_SHARE, LOWEST = 0.005, 1e-3
# A low-pass lets all of the motion through but for NOT_PASSED of the velocity's rms. An octave belongs to the
# motion for sure if the velocity's mean power in it is LOUD, over that in the loudest one.
NOT_PASSED, LOUD = 0.01, 0.1
# Cut-off of the filter that the motion passes first, over that in which forces are compared: derivatives are
# right wherever forces are compared.
WIDER = 2.0
# Part of a record at either end, in periods of the cut-off, in which the filter has not settled.
SETTLING = 2.5
# A step from one sample to the next is part of a jump if it is off by more than JUMP standard deviations from
# the usual one of those around it, in a record of AROUND: a sensor may take some samples to follow.
JUMP, AROUND = 6.0, 9
# Ends of a 95 % interval in standard deviations, and the median of the absolute value of a normal variable.
TWO_SIDED, MEDIAN = float(ndtri(0.975)), float(ndtri(0.75))
# Samples of the Fourier transform by whose frequencies a filter's gain is averaged.
GRID = 8192


@dataclass(frozen=True)
class LowPass:
    """A zero-phase low-pass filter: ``cutoff`` (Hz) and ``rate`` (Hz) of sampling."""

    cutoff: float
    rate: float

    @cached_property
    def _sections(self) -> np.ndarray:
        return signal.butter(ORDER, self.cutoff, fs=self.rate, output="sos")

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """Values (..., n), filtered along the last axis."""
        return signal.sosfiltfilt(self._sections, values, axis=-1)

    @property
    def settling(self) -> int:
        """Samples at either end of a record in which the filter has not settled."""
        return round(SETTLING * self.rate / self.cutoff)

    @property
    def stride(self) -> int:
        """Distance in samples from which on filtered samples of white noise are nearly independent."""
        return max(int(0.5 * self.rate / self.cutoff), 1)

    def noise(self, std: float, order: int = 0) -> float:
        """Standard deviation of filtered white noise, or of its derivative of an ``order``.

        ``std``: of the noise before the filter.
        """
        frequency = self.rate * np.fft.rfftfreq(GRID)
        return std * float(np.sqrt(np.mean(((2.0 * pi * frequency) ** order * self.gain(GRID)) ** 2)))

    def gain(self, size: int) -> np.ndarray:
        """Gain (size // 2 + 1,) at the frequencies of a real Fourier transform of ``size`` samples."""
        return np.abs(signal.sosfreqz(self._sections, 2.0 * pi * np.fft.rfftfreq(size))[1]) ** 2


def derivative(values: np.ndarray, rate: float, order: int = 1) -> np.ndarray:
    """Derivative of samples (..., n) at a rate (Hz), by a spline of degree 5.

    Differences of neighbours would be too small by x^2 / 6 at x rad a sample: at 60 samples a period that
    makes an error of 0.4 % of the inertia.
    """
    places = np.arange(values.shape[-1], dtype=float)
    return make_interp_spline(places, values, k=5, axis=-1)(places, order) * rate**order


def unlike_steps(samples: np.ndarray, around: int) -> np.ndarray:
    """Steps of samples (n,) that are parts of a jump, else 0, less the usual one of ``around``; (n - 1,)."""
    steps = np.diff(samples)
    unlike = steps - median_filter(steps, around, mode="nearest")
    return np.where(np.abs(unlike) > JUMP * float(np.median(np.abs(unlike))) / MEDIAN, unlike, 0.0)


def continuous(samples: np.ndarray) -> np.ndarray:
    """Samples (n,) without their jumps, as dry friction makes a force or an acceleration jump as it turns.

    Each step of a jump is replaced by the usual one there. The power of jumps falls with frequency as that of
    red noise does, up to the highest frequencies of a record: left in, they would be taken for noise.
    """
    return samples - np.r_[0.0, np.cumsum(unlike_steps(samples, AROUND))]


def chosen_cutoff(displacement: np.ndarray, std: float, force: float, mass: float, rate: float) -> float:
    """Cut-off (Hz) for a recorded displacement (n,) in m: see ``highest_cutoff``; the motion passes."""
    speed, passes = _spread(displacement, rate)
    return max(highest_cutoff(std, force, mass, rate, speed), min(passes, HIGHEST * rate))


def _spread(displacement: np.ndarray, rate: float) -> tuple[float, float]:
    """Rms (m/s) of the velocity, and the frequency (Hz) up to which it has all of that but NOT_PASSED.

    What lies beyond the quietest octave is noise of any colour, or a hum.
    """
    frequency = np.fft.rfftfreq(displacement.size, 1.0 / rate)
    speeds = power_of(displacement - displacement.mean()) * (2.0 * pi * frequency) ** 2
    speeds[_quietest(speeds) :] = 0.0
    above = np.cumsum(speeds[::-1])[::-1]
    passed = int(np.argmax(above <= NOT_PASSED**2 * above[0]))
    return float(np.sqrt(2.0 * above[0] / displacement.size)), float(frequency[passed])


def _quietest(speeds: np.ndarray) -> int:
    """First bin of the octave with the least power of a velocity, above all loud ones."""
    edges = [max(int(speeds.argmax()), 1)]
    while 2 * edges[-1] < speeds.size:
        edges.append(2 * edges[-1])
    levels = np.array([speeds[first : 2 * first].mean() for first in edges])
    last = int(np.flatnonzero(levels >= LOUD * levels.max())[-1])
    return edges[last + int(levels[last:].argmin())]


def highest_cutoff(std: float, force: float, mass: float, rate: float, speed: float = inf) -> float:
    """Cut-off (Hz) at which noise is NOISE_SHARE of the force, by inertia, or of the velocity.

    At least LOWEST, at most HIGHEST of the sampling rate.

    Parameters
    ----------
    std : float
        Noise of the displacement (m).
    force : float
        Rms of the force (N).
    mass : float
        Mass that the motion accelerates (kg).
    rate : float
        Sampling rate (Hz).
    speed : float, optional
        Rms of the velocity (m/s).
    """
    limit = HIGHEST * rate

    def excess(cutoff: float) -> float:
        low_pass = LowPass(cutoff, rate)
        return (
            max(low_pass.noise(std, 2) * mass / force, low_pass.noise(std, 1) / max(speed, 1e-300))
            - NOISE_SHARE
        )

    if excess(limit) <= 0.0:
        return limit
    if excess(LOWEST * rate) >= 0.0:
        return LOWEST * rate
    return float(brentq(excess, LOWEST * rate, limit, rtol=1e-4))


@dataclass(frozen=True)
class Motion:
    """An imposed motion on an even grid (m, m/s, m/s^2, shape (n,) each).

    ``noise`` (m, m/s, m/s^2): standard deviation of each of them.
    """

    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    noise: tuple[float, float, float]

    @property
    def parts(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Displacement and its two derivatives."""
        return self.displacement, self.velocity, self.acceleration


def motion(displacement: np.ndarray, std: float, low_pass: LowPass) -> Motion:
    """The motion that a recorded displacement (n,) shows, whose noise has this ``std`` (m).

    ``low_pass`` is the filter in which forces are compared.
    """
    wide = LowPass(WIDER * low_pass.cutoff, low_pass.rate)
    smooth = wide(displacement)
    velocity, acceleration = (derivative(smooth, low_pass.rate, order) for order in (1, 2))
    return Motion(smooth, velocity, acceleration, noise_of_motion(std, low_pass))


def noise_of_motion(std: float, low_pass: LowPass) -> tuple[float, float, float]:
    """Noise of a motion and its two derivatives, for white noise of this ``std`` (m); see ``motion``."""
    wide = LowPass(WIDER * low_pass.cutoff, low_pass.rate)
    return wide.noise(std), wide.noise(std, 1), wide.noise(std, 2)
