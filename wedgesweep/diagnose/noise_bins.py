"""Bins of the spectrum of a record that hold nothing but noise.

Those of the motion stand out, or fall with frequency as steeply as a motion does and noise does not.
"""

from dataclasses import replace
from math import sqrt
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.noise_spectrum import (
    BEST_FIT,
    CONSERVATIVE,
    MOST_NOISE,
    NoiseBins,
    NoiseSpectrum,
    fit_spectra,
    periodogram,
)

# A bin with this many times the power of the noise is part of a line, as are this many neighbours on either
# side. What depends on one another, as noise and lines, is estimated in turn, in ROUNDS.
STANDS_OUT, NEIGHBOURS, ROUNDS = 8.0, 2, 4
# A line above the motion counts as part of it if its power is this many times the noise.
LINE = 30.0
# Standard deviations by which the mean of some bins exceeds the noise if they are skirts of the motion.
SKIRT = 2.0
# Number of bands by which the lower end of the noise is moved up at most.
UPWARDS = 4
# Bands per octave, and ratio of the power of two bands an octave apart beyond which the lower one is motion.
BANDS, STEEP = 2, 12.0
# Least number of bins that must count as noise, and least share of those above the motion.
FEWEST, LEAST_KEPT = 8, 0.25
# A record is divided into PARTS. Those at its end, or beginning, whose rms is at most ALIKE times the least
# one are quiet if there are at least QUIET_PARTS of them, with at most QUIET_SHARE of the record's rms, and
# with at least QUIET_SAMPLES samples.
PARTS, ALIKE, QUIET_PARTS, QUIET_SHARE, QUIET_SAMPLES = 8, 2.0, 2, 0.1, 64


class OwnNoise(NamedTuple):
    """What a record shows of its noise by itself; frequencies in rad a sample.

    ``bins`` of noise, from the frequency ``first`` on; ``highest``: the highest frequency at which the motion
    stands out; ``main``: the one at which it is largest.
    """

    bins: NoiseBins
    first: float
    highest: float
    main: float


def noise_of_record(samples: np.ndarray) -> NoiseSpectrum:
    """The noise in samples (n,) of a motion, from these samples alone."""
    own = noise_bins(samples)
    return replace(fit_spectra([[own.bins]], CONSERVATIVE)[0], highest=own.highest)


def noise_bins(samples: np.ndarray) -> OwnNoise:
    """The bins of samples (n,) of a motion that hold nothing but noise."""
    frequency, power = periodogram(samples)
    enough = max(FEWEST, power.size // 4)
    first = min(_end_of_steep_fall(frequency, power), power.size - enough)
    kept = _without_lines(frequency, power, first)
    for _ in range(UPWARDS):
        following = int(np.searchsorted(frequency, frequency[first] * 2.0 ** (1.0 / BANDS)))
        if following > power.size - enough:
            break
        above = _without_lines(frequency, power, following)
        noise = _fitted(frequency, power, above, MOST_NOISE)(frequency[first:following])
        excess = power[first:following] / noise
        # Skirts of the motion exceed the noise that the bins above them lead one to expect.
        if np.minimum(excess, STANDS_OUT).mean() < 1.0 + SKIRT / sqrt(following - first):
            break
        first, kept = following, above
    found = _fitted(frequency, power, kept, CONSERVATIVE)
    strong = frequency[power > LINE * found(frequency)].max(initial=frequency[first])
    bins, main = NoiseBins.of(frequency[kept], power[kept]), frequency[int(np.argmax(power))]
    return OwnNoise(bins, float(frequency[first]), float(strong), float(main))


def quiet_bins(samples: np.ndarray) -> NoiseBins | None:
    """Bins of noise in the quiet end or beginning of a record (n,); None if it has none.

    There the motion is over, or has not begun, and the noise shows at the motion's own frequencies.
    """
    parts = np.array_split(samples - samples.mean(), PARTS)
    rms = np.array([each.std() for each in parts])
    loud = rms > ALIKE * max(rms.min(), 1e-300)
    before, after = int(np.argmax(loud)), int(np.argmax(loud[::-1]))
    if not loud.any() or max(before, after) < QUIET_PARTS:
        return None
    quiet = np.concatenate(parts[:before] if before > after else parts[PARTS - after :])
    if quiet.size < QUIET_SAMPLES or quiet.std() > QUIET_SHARE * samples.std():
        return None
    return noise_bins(quiet).bins


def _fitted(frequency: np.ndarray, power: np.ndarray, kept: np.ndarray, loss: float) -> NoiseSpectrum:
    return fit_spectra([[NoiseBins.of(frequency[kept], power[kept])]], loss)[0]


def _without_lines(frequency: np.ndarray, power: np.ndarray, first: int) -> np.ndarray:
    """Mask of the bins from the first on in which no line stands out."""
    kept = above = np.arange(power.size) >= first
    for _ in range(ROUNDS):
        ratio = power / _fitted(frequency, power, kept, BEST_FIT)(frequency)
        before, kept = kept, above & ~_with_neighbours(ratio > STANDS_OUT)
        if kept.sum() < max(LEAST_KEPT * above.sum(), FEWEST):
            return before
        if np.array_equal(before, kept):
            break
    return kept


def _end_of_steep_fall(frequency: np.ndarray, power: np.ndarray) -> int:
    """Index of the first bin from which on the power does not fall as steeply as that of a motion."""
    bands = np.floor(BANDS * np.log2(frequency / frequency[0])).astype(int)
    names, sizes = np.unique(bands, return_counts=True)
    if sizes[-1] < sizes[-2]:  # the last band is cut off by half the sampling rate
        bands[bands == names[-1]], names = names[-2], names[:-1]
    median = np.array([np.median(power[bands == name]) for name in names])
    steep = np.zeros(names.size, bool)
    steep[:-BANDS] = median[:-BANDS] > STEEP * median[BANDS:]
    highest = int(np.searchsorted(names, bands[int(np.argmax(power))]))
    last = max(int(np.flatnonzero(steep).max(initial=-1)), highest)
    return int(np.searchsorted(bands, names[last], side="right"))


def _with_neighbours(marked: np.ndarray) -> np.ndarray:
    """Marked bins with their neighbours."""
    return np.convolve(marked, np.ones(2 * NEIGHBOURS + 1), mode="same") > 0.5
