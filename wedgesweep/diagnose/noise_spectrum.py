"""Spectrum of the noise in records, estimated from the records themselves or from repeats of a test.

Noise is taken to be red (a first-order autoregression) and white: S(w) = a/(1 + r^2 - 2 r cos w) + b, with w
in rad a sample. The three numbers are fitted to the periodogram by Whittle's likelihood (Whittle, 1953,
Arkiv foer Matematik 2, 423), at bins that hold nothing but noise (``noise_bins.py``). A sensor has noise of
one shape: r and b/a are common to all tests. Its level may differ from test to test, as ranges of amplifiers
do. Of several r that fit about as well the one with most noise counts, as too low an estimate would look like
a misfit.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import log, pi, sqrt
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.smoothing import TWO_SIDED
from wedgesweep.measured import TestRecord
from wedgesweep.measured.kinds import HIGHEST
from wedgesweep.periodogram import power_of, without_trend

# Poles r that are tried, and iterations of a and b for each (multiplicative updates, see Fevotte and others,
# 2009, Neural Computation 21, 793).
POLES = np.array([0.0, 0.3, 0.5, 0.7, 0.8, 0.87, 0.92, 0.95, 0.97, 0.985, 0.995, 0.999])
UPDATES = 150
# Relative width of the bands over which bins are averaged before they are fitted.
WIDTH = 0.02
# Log-likelihood that colour must gain over white noise.
COLOURED = 3.0
# Variance of the mean of some bins under a Hann window over that of as many independent ones.
CORRELATED = 1.5
# Share of the frequencies, the highest ones, whose power tells the level of a record at first.
HIGH = 0.25
# Frequencies (rad a sample) over which noise is compared.
GRID = np.arange(1, 257) * pi / 256
# What an estimate was taken from, as reported.
FROM_REPEATS, FROM_SPECTRUM = "repeats", "frequencies without motion"
FROM_RESIDUAL = "what an explanation leaves"


@dataclass(frozen=True)
class NoiseSpectrum:
    """Power of the noise by frequency: ``red`` a, ``pole`` r, ``white`` b, in squared units of a sample.

    ``highest``: the highest frequency (rad a sample) at which the motion stands out. ``source``: what the
    estimate was taken from. ``likewise``: other spectra that fit about as well; at each frequency the largest
    of all counts.
    """

    red: float
    pole: float
    white: float
    highest: float = pi
    source: str = FROM_SPECTRUM
    likewise: tuple["NoiseSpectrum", ...] = ()

    def __call__(self, frequency: np.ndarray) -> np.ndarray:
        """Variance of an orthonormal Fourier or cosine coefficient at frequencies in rad a sample."""
        own = self.red * _shape(self.pole, frequency) + self.white
        return np.maximum.reduce([own, *(each(frequency) for each in self.likewise)])

    def amplified(self, factor: float) -> "NoiseSpectrum":
        """Noise whose samples are larger by a factor."""
        likewise = tuple(each.amplified(factor) for each in self.likewise)
        return replace(self, red=factor**2 * self.red, white=factor**2 * self.white, likewise=likewise)

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


class NoiseBins(NamedTuple):
    """Bins of a spectrum that hold nothing but noise: frequency (rad a sample) and power, (b,) each.

    ``known`` (b,): the part of the power that is not of the noise to be estimated; ``weight`` (b,): number of
    bins that each is the mean of.
    """

    frequency: np.ndarray
    power: np.ndarray
    known: np.ndarray
    weight: np.ndarray

    @classmethod
    def of(cls, frequency: np.ndarray, power: np.ndarray, known: np.ndarray | float = 0.0) -> "NoiseBins":
        return cls(frequency, power, known + 0.0 * frequency, np.ones(frequency.size))

    @classmethod
    def joined(cls, sources: Sequence["NoiseBins"]) -> "NoiseBins":
        """Bins from several sources, averaged over bands each, to be fitted faster."""
        averaged = (each._averaged() for each in sources if each.frequency.size)
        return cls(*(np.concatenate(each) for each in zip(*averaged, strict=True)))

    def up_to(self, highest: float) -> "NoiseBins":
        """Those below a frequency (rad a sample)."""
        return NoiseBins(*(each[self.frequency < highest] for each in self))

    def _averaged(self) -> "NoiseBins":
        """Means over bands in which no spectrum changes much."""
        order = np.argsort(self.frequency, kind="stable")
        bands = np.floor(np.log(self.frequency[order]) / WIDTH)
        count = np.unique(bands, return_counts=True)[1].astype(float)
        first = np.r_[0, np.cumsum(count[:-1])].astype(int)
        mean = [np.add.reduceat(each[order], first) / count for each in self[:3]]
        return NoiseBins(mean[0], mean[1], mean[2], count)


def of_noise(
    records: Sequence[np.ndarray], source: str, known: Callable[[np.ndarray], np.ndarray] | None = None
) -> NoiseSpectrum:
    """Spectrum of noise from records (n,) of nothing else.

    ``source``: what the records are, for reports; ``known``: gives power by frequency (rad a sample) that the
    records have beside the noise to be estimated.
    """
    both = [periodogram(each) for each in records]
    frequency, power = (np.concatenate(each) for each in zip(*both, strict=True))
    bins = NoiseBins.of(frequency, power, known(frequency) if known else 0.0)
    return replace(fit_spectra([[bins]], CONSERVATIVE)[0], source=source)


def periodogram(samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (rad a sample), and power at them, under a Hann window; without 0 and the first bin."""
    found = power_of(without_trend(samples))[2:]
    return (np.arange(found.size) + 2) * 2.0 * pi / samples.size, found


def white_noise(samples: np.ndarray) -> float:
    """Standard deviation of the white noise in samples (n,), by their power above that of a motion.

    The result is the upper end of the 95 % interval: in a short record an estimate that is too low would look
    like a misfit. The median counts, so that lines do not.
    """
    frequency, power = periodogram(samples)
    above = power[frequency > 2.0 * pi * HIGHEST]
    # The power of noise has a median of log 2, which scatters by 1 / sqrt(n) in n independent bins.
    raised = 1.0 + TWO_SIDED * sqrt(CORRELATED / above.size) / log(2.0)
    return sqrt(raised * float(np.median(above)) / log(2.0))


# Log-likelihood that a spectrum may lack to count beside the best one: none for the maximum-likelihood one,
# and for spectra that err to the safe side, at an upper end of 68 % and of 95 % intervals.
BEST_FIT, CONSERVATIVE, MOST_NOISE = 0.0, 0.5, 2.0


def fit_spectra(
    tests: Sequence[Sequence[NoiseBins]], loss: float = MOST_NOISE, coloured: float = COLOURED
) -> list[NoiseSpectrum]:
    """Spectra of the noise of T tests, of one shape but each of its own level.

    White noise is taken, unless colour gains more than ``coloured`` in log-likelihood. Else, of all poles
    whose log-likelihood is at most ``loss`` below the best one, that with most noise is taken; the others
    count as well, at frequencies where they have more. Levels are raised to the upper end of their 95 %
    interval, unless ``loss`` is 0. ``tests``: bins of each test, from one source or several.
    """
    own = [NoiseBins.joined(each) for each in tests]
    bands = NoiseBins(*(np.concatenate(each) for each in zip(*own, strict=True)))
    member = np.repeat(np.eye(len(own)), [each.weight.size for each in own], axis=0)
    bins = bands.weight @ member
    mean = (bands.weight * bands.power) @ member / bins
    bands = bands._replace(known=bands.known + member @ (1e-12 * mean + 1e-300))
    found = _fitted(bands, member, np.array([_at_first(each) for each in own]))
    raised = 0.0 if loss == BEST_FIT else TWO_SIDED * np.sqrt(CORRELATED / bins)
    best, *others = (
        [found.spectrum(place, level) for level in found.level[place] * (1.0 + raised)]
        for place in _chosen(found, loss, coloured)
    )
    return [replace(each, likewise=tuple(like)) for each, *like in zip(best, *others, strict=True)]


def _chosen(found: "_Fitted", most: float, coloured: float) -> list[int]:
    """Indices of the poles that are taken, the leading one first; [0], white noise, unless colour is seen."""
    loss = found.loss - found.loss.min()
    if loss[0] <= coloured:
        return [0]
    mean_power = (found.red[:, None] * _shape(POLES[:, None], GRID) + found.white[:, None]).mean(axis=1)
    mean_power = mean_power * found.level[:, 0]
    good = np.flatnonzero(loss <= most)
    return good[np.argsort(-mean_power[good])].tolist()


def _shape(pole: float | np.ndarray, frequency: np.ndarray) -> np.ndarray:
    return 1.0 / (1.0 + pole**2 - 2.0 * pole * np.cos(frequency))


def _at_first(bands: NoiseBins) -> float:
    """First estimate of the level of a test: its mean power at the highest frequencies."""
    high = bands.frequency >= (1.0 - HIGH) * bands.frequency.max()
    return max(float((bands.weight * bands.power)[high].sum() / bands.weight[high].sum()), 1e-300)


class _Fitted(NamedTuple):
    """For each pole: red a and white b (r,), level (r, T) of each test, and minus the log-likelihood (r,)."""

    red: np.ndarray
    white: np.ndarray
    level: np.ndarray
    loss: np.ndarray

    def spectrum(self, place: int, level: float) -> NoiseSpectrum:
        """The noise with one of the poles, at some level."""
        red, white = self.red[place], self.white[place]
        if place == 0:
            red, white = 0.0, red + white
        return NoiseSpectrum(float(level * red), float(POLES[place]), float(level * white))


def _fitted(bands: NoiseBins, member: np.ndarray, level: np.ndarray) -> _Fitted:
    """Maximum likelihood for each pole.

    ``member`` (b, T): 1 where a band is of a test, else 0; ``level`` (T,): first estimate.
    """
    bins, shape = bands.weight, _shape(POLES[:, None], bands.frequency)
    high = _shape(POLES, np.array(pi))[:, None]
    red, white = 0.5 / high, np.full((POLES.size, 1), 0.5)
    levels = np.tile(level, (POLES.size, 1))

    def factor(part: np.ndarray, to: np.ndarray) -> np.ndarray:
        """Multiplicative updates (r, k) of k numbers that scale a part (r, b) of the power.

        ``to`` (b, k): 1 where a number scales the part in a band, else 0.
        """
        total = levels @ member.T * (red * shape + white) + bands.known
        rises, falls = bins * bands.power * part / total**2, bins * part / total
        return np.asarray((rises @ to) / np.maximum(falls @ to, 1e-300))

    everywhere = np.ones((bins.size, 1))
    for _ in range(UPDATES):
        red = red * factor(levels @ member.T * shape, everywhere)
        white = white * factor(levels @ member.T, everywhere)
        if level.size > 1:
            levels = levels * factor(red * shape + white, member)
    total = levels @ member.T * (red * shape + white) + bands.known
    loss = (bins * (bands.power / total + np.log(total))).sum(axis=-1) / CORRELATED
    return _Fitted(red[:, 0], white[:, 0], levels, loss)


# Largest delay between repeats, as a share of their length.
SHIFT = 0.02


def repeat_groups(tests: Sequence[TestRecord]) -> list[list[int]]:
    """Indices of the tests of each group that repeat one another."""
    by_file: dict[str, list[int]] = {}
    for place, test in enumerate(tests):
        by_file.setdefault(test.repeat_of or test.file, []).append(place)
    return [rows for rows in by_file.values() if len(rows) > 1]


def repeat_differences(records: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Noise of repeats of a test: what the others do not explain of each record (n,).

    Repeats never start alike. The mean of the others is fitted to each, a little larger, a little later, and
    with another zero and drift. Residuals are scaled to the variance of the record's own noise. All records
    are cut to the length of the shortest.
    """
    size = min(each.size for each in records)
    cut = np.array([each[:size] for each in records])
    # The mean of the others has noise as well.
    variance = 1.0 + 1.0 / (len(records) - 1)
    return [_residual(cut[i], np.delete(cut, i, axis=0)) / np.sqrt(variance) for i in range(len(records))]


def _residual(record: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Residual (n,) of a record after a fit of the mean of others (m, n), each delayed to where it fits."""
    mean = np.mean([_delayed(each, _delay(record, each)) for each in others], axis=0)
    place = np.linspace(-1.0, 1.0, record.size)
    columns = np.column_stack([mean, np.gradient(mean), mean * place, np.ones(record.size), place])
    columns /= np.maximum(np.abs(columns).max(axis=0), 1e-300)
    return record - columns @ np.linalg.lstsq(columns, record, rcond=None)[0]


def _delay(one: np.ndarray, other: np.ndarray) -> int:
    """Samples by which one record lags behind another, within SHIFT."""
    longest = int(SHIFT * one.size)
    return longest - int(np.correlate(other, one[longest : one.size - longest], "valid").argmax())


def _delayed(record: np.ndarray, lag: int) -> np.ndarray:
    """A record (n,) that begins a number of samples later; its ends are repeated."""
    places = np.clip(np.arange(record.size) - lag, 0, record.size - 1)
    return record[places]
