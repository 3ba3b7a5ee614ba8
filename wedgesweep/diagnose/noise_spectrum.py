"""The spectrum of the noise in a record, where the record itself, or repeats of it, must tell.

Noise is taken to be red and white: S(w) = a/(1 + r^2 - 2 r cos w) + b, with w in rad a sample. Its three
numbers fit the periodogram by Whittle's likelihood (Whittle, 1953, Arkiv foer Matematik 2, 423) at the
frequencies at which noise is all there is: those that stand out are of the motion. That assumes that the
noise at the motion's frequencies goes on as it is above them. Of several r that fit about as well the one
with most noise counts, as an estimate that is too low would look like a misfit.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import pi, sqrt
from typing import NamedTuple

import numpy as np

# Poles r that are tried, and iterations of a and b for each (multiplicative updates, see Fevotte and others,
# 2009, Neural Computation 21, 793).
POLES = np.array([0.0, 0.3, 0.5, 0.7, 0.8, 0.87, 0.92, 0.95, 0.97, 0.985, 0.995, 0.999])
UPDATES = 150
# Relative width of the bands over which bins are averaged before they are fitted.
WIDTH = 0.02
# A frequency stands out if its power is this many times the noise, and so do its neighbours; found in rounds.
STANDS_OUT, NEIGHBOURS, ROUNDS = 8.0, 2, 4
# Power over the noise of a line above the motion that is told of.
LINE = 30.0
# Standard deviations by which the mean of some bins exceeds the noise if they are skirts of the motion.
SKIRT = 2.0
# Bands by which the first one that counts as noise is moved up at most.
UPWARDS = 4
# Bands in an octave, over one of which power that falls by more than this is of the motion.
BANDS, STEEP = 2, 12.0
# Least share of the bins above the motion, and least number of bins, that must count as noise.
LEAST_KEPT, FEWEST = 0.25, 8
# Log-likelihood that colour must gain over white noise, and its loss at which another pole fits as well.
COLOURED, AS_WELL = 3.0, 0.5
# Standard deviations by which the level is raised: one end of a 95 % interval.
ONE_END = 1.96
# Variance of a bin that a Hann window leaves over that of independent ones.
CORRELATED = 1.5
# Where the level comes from, as it is told.
FROM_REPEATS, FROM_SPECTRUM = "repeats", "frequencies without motion"


@dataclass(frozen=True)
class NoiseSpectrum:
    """Power of the noise by frequency: ``red`` a, ``pole`` r, ``white`` b, in squared units of a sample.

    ``highest``: the highest frequency (rad a sample) at which the motion stands out. ``source``: what the
    estimate is taken from.
    """

    red: float
    pole: float
    white: float
    highest: float = pi
    source: str = FROM_SPECTRUM

    def __call__(self, frequency: np.ndarray) -> np.ndarray:
        """Variance of an orthonormal Fourier or cosine coefficient at frequencies in rad a sample."""
        return self.red * _shape(self.pole, frequency) + self.white

    def up_to(self, highest: float) -> "NoiseSpectrum":
        """The same noise in a record whose motion stands out up to a frequency (rad a sample)."""
        return replace(self, highest=highest)

    @property
    def std(self) -> float:
        """Standard deviation of a sample."""
        return sqrt(self.red / (1.0 - self.pole**2) + self.white)

    def covariance(self, distance: np.ndarray) -> np.ndarray:
        """Covariance of two samples by their distance in samples."""
        red = self.red / (1.0 - self.pole**2) * self.pole ** distance.astype(float)
        return red + self.white * (distance == 0)

    @property
    def correlation(self) -> float:
        """Correlation of one sample with the next."""
        variance = self.red / (1.0 - self.pole**2)
        return self.pole * variance / max(variance + self.white, 1e-300)


def _shape(pole: float | np.ndarray, frequency: np.ndarray) -> np.ndarray:
    return 1.0 / (1.0 + pole**2 - 2.0 * pole * np.cos(frequency))


def of_record(samples: np.ndarray) -> NoiseSpectrum:
    """The noise in samples (n,) of a motion."""
    frequency, power = periodogram(samples)
    enough = max(FEWEST, power.size // 4)
    first = min(_faded(frequency, power), power.size - enough)
    kept = _without_lines(frequency, power, first)
    for _ in range(UPWARDS):
        following = int(np.searchsorted(frequency, frequency[first] * 2.0 ** (1.0 / BANDS)))
        if following > power.size - enough:
            break
        above = _without_lines(frequency, power, following)
        noise = _fit(frequency, power, above, 4.0 * AS_WELL)(frequency[first:following])
        excess = power[first:following] / noise
        # Skirts of the motion exceed what the noise above them leads one to expect.
        if np.minimum(excess, STANDS_OUT).mean() < 1.0 + SKIRT / sqrt(following - first):
            break
        first, kept = following, above
    found = _fit(frequency, power, kept, AS_WELL)
    strong = frequency[power > LINE * found(frequency)].max(initial=frequency[first])
    return NoiseSpectrum(found.red, found.pole, found.white, float(strong))


def _without_lines(frequency: np.ndarray, power: np.ndarray, first: int) -> np.ndarray:
    """Bins from the first on in which no line stands out."""
    kept = above = np.arange(power.size) >= first
    for _ in range(ROUNDS):
        ratio = power / _fit(frequency, power, kept, as_well=0.0)(frequency)
        before, kept = kept, above & ~_spread(ratio > STANDS_OUT)
        if kept.sum() < max(LEAST_KEPT * above.sum(), FEWEST):
            return before
        if np.array_equal(before, kept):
            break
    return kept


def _faded(frequency: np.ndarray, power: np.ndarray) -> int:
    """The first bin above which the power no longer falls as steeply as that of a motion does."""
    bands = np.floor(BANDS * np.log2(frequency / frequency[0])).astype(int)
    names, sizes = np.unique(bands, return_counts=True)
    if sizes[-1] < sizes[-2]:  # the last one is not complete
        bands[bands == names[-1]], names = names[-2], names[:-1]
    median = np.array([np.median(power[bands == name]) for name in names])
    steep = np.zeros(names.size, bool)
    steep[:-BANDS] = median[:-BANDS] > STEEP * median[BANDS:]
    highest = int(np.searchsorted(names, bands[int(np.argmax(power))]))
    last = max(int(np.flatnonzero(steep).max(initial=-1)), highest)
    return int(np.searchsorted(bands, names[last], side="right"))


def of_noise(
    records: Sequence[np.ndarray], source: str, known: Callable[[np.ndarray], np.ndarray] | None = None
) -> NoiseSpectrum:
    """The noise whose samples are known, up to the lowest frequencies, in records (n,) each.

    ``known``: power that part of it has by frequency (rad a sample), which is not part of the result.
    """
    both = [periodogram(each) for each in records]
    frequency, power = (np.concatenate(each) for each in zip(*both, strict=True))
    order = np.argsort(frequency, kind="stable")
    frequency, power = frequency[order], power[order]
    floor = np.zeros(frequency.size) if known is None else known(frequency)
    found = _fit(frequency, power, np.ones(order.size, bool), AS_WELL, floor)
    return NoiseSpectrum(found.red, found.pole, found.white, source=source)


def periodogram(samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (rad a sample) but the lowest ones, and power at them, under a Hann window."""
    place = np.arange(samples.size) - 0.5 * (samples.size - 1)
    level = samples - samples.mean() - place * (place @ samples) / (place @ place)
    window = np.hanning(samples.size)
    power = np.abs(np.fft.rfft(level * window)) ** 2 / (window**2).sum()
    frequency = np.arange(power.size) * 2.0 * pi / samples.size
    return frequency[2:], power[2:]


def _spread(marked: np.ndarray) -> np.ndarray:
    """Marked bins with their neighbours."""
    return np.convolve(marked, np.ones(2 * NEIGHBOURS + 1), mode="same") > 0.5


class _Bands(NamedTuple):
    """Means over narrow bands of bins: frequency, power, known power, and number of bins, (b,) each."""

    frequency: np.ndarray
    power: np.ndarray
    known: np.ndarray
    bins: np.ndarray


def _bands(frequency: np.ndarray, power: np.ndarray, known: np.ndarray) -> _Bands:
    """Bins by rising frequency in bands, over which no spectrum changes much."""
    first = np.flatnonzero(np.diff(np.floor(np.log(frequency) / WIDTH), prepend=-np.inf))
    bins = np.diff(np.r_[first, frequency.size])
    mean = [np.add.reduceat(each, first) / bins for each in (frequency, power, known)]
    return _Bands(mean[0], mean[1], mean[2], bins)


def _fit(
    frequency: np.ndarray,
    power: np.ndarray,
    kept: np.ndarray,
    as_well: float,
    floor: np.ndarray | None = None,
) -> NoiseSpectrum:
    """Fit to the kept bins; of poles that fit about as well the one with most noise elsewhere.

    ``floor``: power that is known and comes on top.
    """
    known = np.zeros(frequency.size) if floor is None else floor
    own = _bands(frequency[kept], power[kept], known[kept])
    mean = float(power[kept].mean())
    own = own._replace(known=own.known + 1e-12 * mean + 1e-300)
    here, least, bins, shape = own.power, own.known, own.bins, _shape(POLES[:, None], own.frequency)
    red, white = 0.5 * mean * bins.sum() / (bins * shape).sum(axis=1), np.full(POLES.size, 0.5 * mean)
    for _ in range(UPDATES):
        level = red[:, None] * shape + white[:, None] + least
        red *= (bins * here * shape / level**2).sum(axis=1) / (bins * shape / level).sum(axis=1)
        level = red[:, None] * shape + white[:, None] + least
        white *= (bins * here / level**2).sum(axis=1) / (bins / level).sum(axis=1)
    loss = _loss(own, red[:, None] * shape + white[:, None] + least)
    alone = _white(own)
    raised = 1.0 + ONE_END * sqrt(CORRELATED / kept.sum()) if as_well else 1.0
    if _loss(own, alone + least) <= loss.min() + COLOURED:
        return NoiseSpectrum(0.0, 0.0, raised * alone)
    elsewhere = red * _shape(POLES[:, None], frequency).mean(axis=1) + white
    good = np.flatnonzero(loss <= loss.min() + as_well)
    best = int(good[np.argmax(elsewhere[good])])
    return NoiseSpectrum(float(raised * red[best]), float(POLES[best]), float(raised * white[best]))


def _loss(own: _Bands, level: np.ndarray) -> np.ndarray:
    """Minus Whittle's log-likelihood of noise of some level (..., b)."""
    return (own.bins * (own.power / level + np.log(level))).sum(axis=-1) / CORRELATED


def _white(own: _Bands) -> float:
    """White noise that fits bands best on top of what is known."""
    white = float((own.bins * own.power).sum() / own.bins.sum())
    for _ in range(UPDATES):
        level = white + own.known
        white *= float((own.bins * own.power / level**2).sum() / (own.bins / level).sum())
    return white
