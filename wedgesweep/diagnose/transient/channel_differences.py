"""What two channels of a record do not share: their noise, at the frequencies of the motion as well.

Velocity is the derivative of displacement, whatever moves. With a window w that ends at zero, weighted sums
say so without differentiating any noise: sum(w v) = -sum(w' x). What is left between the two is noise of the
one, and noise of the other times the frequency. A sensor may have a gain, and lag by a first-order filter;
both are fitted, once for all tests.

What this is worth: releases with a damper that the model lacks, at 1 % noise of both channels, leave 4.7
times the squared noise (1.7 times under red noise). With each channel by itself, whose noise is then taken
to be larger, they would leave 1.3 times (0.5 times): nothing would be missing.
"""

from collections.abc import Sequence
from math import comb, pi
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.noise_spectrum import NoiseBins, NoiseSpectrum

# Number of lowest frequencies that are left out: the window leaks a mean or a drift into them.
LOWEST = 2
# Least amplitude, over the largest one, of bins from which gain and lag are estimated.
MOVING = 0.1


class Difference(NamedTuple):
    """Difference of two channels of a test, by ``frequency`` (f,) in rad a sample.

    ``power`` (f,): of the difference, as noise of a sample of the higher derivative; ``share`` (f,): factor
    by which the power of the noise of the lower derivative enters it.
    """

    frequency: np.ndarray
    power: np.ndarray
    share: np.ndarray

    def of_higher(self, lower: NoiseSpectrum) -> NoiseBins:
        """Bins of noise of the higher derivative, where that of the lower one is known."""
        return NoiseBins.of(self.frequency, self.power, self.share * lower(self.frequency))

    def of_lower(self, higher: NoiseSpectrum) -> NoiseBins:
        """Bins of noise of the lower derivative, where that of the higher one is known."""
        return NoiseBins.of(self.frequency, self.power / self.share, higher(self.frequency) / self.share)


class _Sums(NamedTuple):
    """Windowed Fourier sums (f,) by ``frequency`` (rad a sample).

    ``higher``: of the higher derivative; ``predicted``: the same by the lower one; ``change``: of the rate of
    change of the higher one a sample, which a lag multiplies.
    """

    frequency: np.ndarray
    higher: np.ndarray
    predicted: np.ndarray
    change: np.ndarray


def differences(pairs: Sequence[tuple[np.ndarray, np.ndarray]], orders: int, rate: float) -> list[Difference]:
    """Differences of two channels in each test.

    Parameters
    ----------
    pairs : sequence of two ndarray, shape (n,) each
        A channel of each test, and another one that is a derivative of it.
    orders : int
        The order of that derivative, 1 or 2.
    rate : float
        Sampling rate (Hz).
    """
    tests = [_sums(lower * rate**orders, higher, orders) for lower, higher in pairs]
    columns = np.concatenate([np.column_stack([each.predicted, each.change]) for each in tests])
    measured = np.concatenate([each.higher for each in tests])
    # At other frequencies the columns are noise, which would make the gain too small.
    moving = np.concatenate([np.abs(each.higher) > MOVING * np.abs(each.higher).max() for each in tests])
    matrix, values = (
        np.concatenate([each.real, each.imag])[np.r_[moving, moving]] for each in (columns, measured)
    )
    size = np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
    gain, lag = np.linalg.lstsq(matrix / size, values, rcond=None)[0] / size
    left = np.split(measured - columns @ [gain, lag], np.cumsum([each.higher.size for each in tests])[:-1])
    found = []
    for each, rest in zip(tests, left, strict=True):
        own = 1.0 + (lag * each.frequency) ** 2
        share = (gain * (rate * each.frequency) ** orders) ** 2 / own
        found.append(Difference(each.frequency, np.abs(rest) ** 2 / own, share))
    return found


def _sums(lower: np.ndarray, higher: np.ndarray, orders: int) -> _Sums:
    """Sums under a Hann window, over its rms; the first and last samples, at its ends, count half."""
    lower, higher = lower - lower.mean(), higher - higher.mean()
    size = lower.size - 1
    angle = 2.0 * pi * np.arange(size + 1) / size
    window = 0.5 * (1.0 - np.cos(angle)), pi / size * np.sin(angle), 2.0 * (pi / size) ** 2 * np.cos(angle)
    count = size // 2 + 1
    frequency = 2.0 * pi * np.arange(count) / size

    def sums(values: np.ndarray, order: int) -> np.ndarray:
        """Sums of a derivative of values, by parts: the turning window is differentiated in its place."""
        own = (_transformed(values * each) for each in window[: order + 1])
        parts = (comb(order, k) * (1j * frequency) ** (order - k) * each for k, each in enumerate(own))
        return sum((-1) ** k * each for k, each in enumerate(parts))

    rms = np.sqrt((window[0] ** 2).sum())
    kept = slice(LOWEST, None)
    return _Sums(
        frequency[kept],
        *(each[kept] / rms for each in (sums(higher, 0), sums(lower, orders), sums(higher, 1))),
    )


def _transformed(values: np.ndarray) -> np.ndarray:
    """Fourier sums (f,) of values (n + 1,), of which the first and the last one are at the same phase."""
    folded = values[:-1].copy()
    folded[0] = 0.5 * (values[0] + values[-1])
    return np.fft.rfft(folded)
