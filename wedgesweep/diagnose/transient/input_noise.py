"""Noise of a recorded input as a simulated response passes it on.

The noise is a sum of cosines over the simulated span of a window, each with its own variance. Each is added
to the input and subtracted from it; half the difference of the two responses is what that cosine does. At a
resonance this is noise of a narrow band, whose neighbouring coefficients are far from independent.
"""

from dataclasses import replace
from math import pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.fft import dct

from wedgesweep.diagnose.sampled_data import LARGEST_BLOCK, Decorrelation, decorrelation
from wedgesweep.sampled_input import SampledInput, polynomials

# Knots of the input beyond a window to either side.
BEYOND = 3


class InputNoise(NamedTuple):
    """Noise of a recorded input.

    ``power`` (f,): of a sample by frequency, from 0 to half the sampling rate; ``integrated``: how often what
    was recorded is integrated to what acts; ``cutoff`` (rad a sample): highest frequency that acts;
    ``shares`` (C,): of the base's displacement in each channel, which was converted with it.
    """

    power: np.ndarray
    integrated: int
    cutoff: float
    shares: tuple[float, ...]

    def of_acting(self, frequency: np.ndarray, step: float) -> np.ndarray:
        """Variance (m^2, or N^2 of a force) of a cosine of what acts, at frequencies in rad a sample."""
        recorded = np.interp(frequency, np.linspace(0.0, pi, self.power.size), self.power)
        return recorded / (frequency / step) ** (2 * self.integrated)


class Cosines(NamedTuple):
    """Cosines by which the input of a window may be wrong.

    ``size`` (k,): standard deviation of each, in the orthonormal basis of n ``samples``, ``step`` (s) apart;
    ``frequency`` (k,) in rad a sample.
    """

    size: np.ndarray
    frequency: np.ndarray
    samples: int
    step: float

    def at(self, times: np.ndarray) -> np.ndarray:
        """Their values (k, t) at times (s) from the first simulated sample."""
        angles = np.multiply.outer(self.frequency, times / self.step + 0.5)
        return self.size[:, None] * sqrt(2.0 / self.samples) * np.cos(angles)


def cosines(noise: InputNoise, samples: int, step: float, highest: float) -> Cosines:
    """The cosines up to a frequency (rad a sample)."""
    count = int(min(noise.cutoff, highest) * samples / pi)
    frequency = pi * np.arange(1, max(count, 1) + 1) / samples
    return Cosines(np.sqrt(noise.of_acting(frequency, step)), frequency, samples, step)


def disturbed(given: SampledInput, parts: Cosines) -> list[SampledInput]:
    """The input with each of the cosines added, then with each of them taken away."""
    first, last = (np.array([0.0, parts.samples * parts.step]) - given.begin) / given.step
    begin = min(max(int(first) - BEYOND, 0), len(given.coefficients) - 1)
    end = min(int(last) + BEYOND + 1, len(given.coefficients))
    own = given.coefficients[begin : max(end, begin + 1)]
    start = given.begin + begin * given.step
    knots = start + given.step * np.arange(len(own) + 1)
    changes = polynomials(parts.at(knots).T, given.step)
    return [
        replace(given, coefficients=own + sign * each, begin=start)
        for sign in (1.0, -1.0)
        for each in changes
    ]


def decorrelated(own: np.ndarray, changes: np.ndarray) -> tuple[Decorrelation, ...]:
    """Combinations with independent noise of the first LARGEST_BLOCK coefficients of each channel.

    Parameters
    ----------
    own : ndarray, shape (C, K)
        Variance of each coefficient that does not come from the input.
    changes : ndarray, shape (k, C, n)
        What each cosine of the input does to each channel.
    """
    size = min(own.shape[1], LARGEST_BLOCK)
    by_input = np.moveaxis(dct(changes, norm="ortho")[..., :size], 1, 0)

    def combinations(variance: np.ndarray, change: np.ndarray) -> Decorrelation:
        covariance = np.diag(variance[:size]) + change.T @ change
        return decorrelation(np.ones(size, bool), lambda rows: covariance[np.ix_(rows, rows)], 0.0)

    return tuple(map(combinations, own, by_input))
