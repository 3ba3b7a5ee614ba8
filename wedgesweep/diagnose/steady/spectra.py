"""Measured signals as harmonics with their noise.

A forced response repeats each period, noise does not. One least-squares fit over the whole record gives
the harmonics, whatever the sampling rate; what is left between them gives the noise near each of them
(after Pintelon and Schoukens, System Identification, 2012, ch. 4).
"""

from dataclasses import dataclass, replace
from math import pi
from typing import NamedTuple

import numpy as np
from scipy.special import gammaincc

from wedgesweep.diagnose.steady import noise_psd
from wedgesweep.diagnose.steady.aliasing import AliasMap, alias_map
from wedgesweep.diagnose.steady.noise_psd import SmoothPSD

# Harmonics that are compared with a simulation, and that are taken out before the noise is measured.
COMPARED, REMOVED = 16, 40
# Harmonics that a simulation knows of, and whose images beyond half the sampling rate count.
SIMULATED = 127
# Highest frequency that is used, over the sampling rate.
BAND = 0.4
# The noise is looked at between harmonics, at multiples of this part of the input frequency.
PARTS = 8
# Lines of which a fit leaves less than this share say nothing of the noise.
LEAST_LEFT = 0.2
# Two channels whose noise is more coherent than this say the same.
SAME = 0.98
# Chance of lines at half multiples of the input frequency in a response that repeats each period.
DOUBLED = 1e-4
# Frequencies this many resolutions (one over the record) apart are told apart.
RESOLVED = 1.2
# Lines (resolutions) that a tone and a harmonic make together hide the noise as close as this; share of the
# lines that must be left without them.
TONE_LINE_WIDTH, LEAST_CLEAR_SHARE = 0.8, 0.3
# Closer than this a tone is the harmonic; farther off it leaks into all of them, and is taken out.
MINGLED = 0.05


@dataclass(frozen=True)
class Spectrum:
    """Harmonics of one test; channels are displacement x - y (m) and velocity x' - y' (m/s).

    ``mean`` (channels, harmonics), complex: signal = Re sum D_h exp(i h omega t) from the first sample;
    ``variance`` (channels, harmonics): of one such complex number, real and imaginary part together;
    ``coherence``: of the noise of both channels, complex; ``level``: its smooth spectrum, per channel.
    ``residual`` (channels, n): what is left of the record. ``tone``: a foreign frequency (Hz) whose complex
    amplitude is the last column of ``mean``. A tone that the record cannot tell from a harmonic has none, and
    that harmonic, ``masked`` (1, 2, ...), says nothing. ``folding``: what harmonics above half the sampling
    rate add to ``mean``, None for nothing.
    """

    frequency: float
    periods: float
    samples: int
    interval: float
    mean: np.ndarray
    variance: np.ndarray
    coherence: complex
    residual: np.ndarray
    level: tuple[SmoothPSD, ...]
    tone: float | None = None
    masked: int | None = None
    alias_map: AliasMap | None = None

    @property
    def duration(self) -> float:
        """Length of the record (s)."""
        return self.samples * self.interval

    @property
    def observations(self) -> int:
        """Real numbers that say something."""
        return 2 * (self.mean.size - (self.masked is not None) * self.mean.shape[0])

    @property
    def has_tone(self) -> bool:
        """Whether a foreign tone shows, by itself or mixed up with a harmonic."""
        return self.tone is not None or self.masked is not None

    @property
    def sample_noise(self) -> np.ndarray:
        """Noise of one sample (channels,), in m and m/s."""
        return np.sqrt(self.variance.mean(axis=1) * self.samples / 4.0)

    @property
    def harmonics(self) -> int:
        """Number of harmonics, a tone not counted."""
        return self.mean.shape[1] - (self.tone is not None)

    def excess_at(self, frequencies: np.ndarray) -> np.ndarray:
        """Power at some frequencies over the smooth noise, summed over channels (1 each in noise)."""
        padded = 8 * self.samples
        transform = np.fft.rfft(self.residual, padded, axis=1)
        # What lies beyond the record's band says nothing, whatever it is.
        bins = np.minimum(np.round(frequencies * self.interval * padded).astype(int), padded // 2)
        power = np.abs(transform[:, bins]) ** 2 / self.samples
        return sum(each / level(frequencies) for each, level in zip(power, self.level, strict=True))

    def with_undetected_tone(self, frequency: float) -> "Spectrum":
        """As if a tone had been looked for at a frequency (Hz), and nothing been there but noise."""
        if not self.resolves(np.array([frequency]))[0]:
            return self
        variance = [4.0 / self.samples * level.unbiased(np.array([frequency])) for level in self.level]
        mean = np.concatenate([self.mean, np.zeros((len(self.mean), 1))], axis=1)
        return replace(
            self,
            mean=mean,
            variance=np.concatenate([self.variance, variance], axis=1),
            tone=frequency,
            alias_map=None,
        )

    def resolves(self, frequencies: np.ndarray) -> np.ndarray:
        """Whether the record tells these frequencies from the harmonics, in the band of those compared."""
        return resolvable(frequencies, self.frequency, self.duration, self.harmonics)


def _beside(frequencies: np.ndarray | float, frequency: float) -> np.ndarray:
    """Distance (Hz) of frequencies from the closest harmonic."""
    return np.abs(frequencies - frequency * np.round(frequencies / frequency))


def within_band(most: int, frequency: float, interval: float) -> int:
    """How many harmonics, ``most`` at the most, a record sampled each ``interval`` (s) shows."""
    return min(most, int(BAND / interval / frequency))


def resolvable(tones: np.ndarray, frequency: float, duration: float, harmonics: int) -> np.ndarray:
    """Whether a record (s) tells tones (Hz) from the harmonics, in the band of those that are compared."""
    resolved = _beside(tones, frequency) * duration > RESOLVED
    return resolved & (tones < frequency * (harmonics + 1))


def tone_position(tone: float, frequency: float, duration: float, harmonics: int) -> tuple[bool, int | None]:
    """Whether a record tells a tone from the harmonics that are compared, and else which one it covers."""
    if resolvable(np.array(tone), frequency, duration, harmonics):
        return True, None
    closest = round(tone / frequency)
    covers = _beside(tone, frequency) * duration <= RESOLVED and 1 <= closest <= harmonics
    return False, closest if covers else None


def regressors(time: np.ndarray, frequency: float, harmonics: int) -> np.ndarray:
    """Constant, drift, and cosine and sine of each harmonic, shape (n, 2 + 2 * harmonics)."""
    turns = _turns(time, frequency, harmonics).T
    slow = np.stack([np.ones_like(time), 2.0 * time / time[-1] - 1.0], axis=1)
    return np.concatenate([slow, turns.real, turns.imag], axis=1)


def _turns(time: np.ndarray, frequency: float, multiples: int) -> np.ndarray:
    """exp(2 pi i k f t) for k = 1..multiples, shape (multiples, n), as powers of the first."""
    first = np.exp(2j * pi * frequency * time)
    return np.multiply.accumulate(np.repeat(first[None], multiples, axis=0), axis=0)


def spectrum(time: np.ndarray, channels: np.ndarray, frequency: float, tone: float | None = None) -> Spectrum:
    """Harmonics of the channels, shape (channels, n), of one test; ``time`` (n,) in s, frequencies in Hz."""
    once = fitted(time, channels, frequency, tone)
    return fitted(time, channels, frequency, tone, doubled=True) if _doubled(once, tone) else once


def _doubled(spectrum: Spectrum, tone: float | None) -> bool:
    """Whether a response repeats only every other period: odd multiples of half the frequency stand out.

    The strongest of them does not count: it may be a foreign tone. Where a known one is as close to one of
    them as to be mixed up, what stands out comes from that.
    """
    if tone is not None and _beside(tone, 0.5 * spectrum.frequency) * spectrum.duration <= RESOLVED:
        return False
    odd = np.arange(1, 2 * spectrum.harmonics + 2, 2)
    power = np.sort(spectrum.excess_at(0.5 * spectrum.frequency * odd))[:-1]
    return bool(gammaincc(power.size * spectrum.mean.shape[0], power.sum()) < DOUBLED)


def fitted(
    time: np.ndarray, channels: np.ndarray, frequency: float, tone: float | None = None, doubled: bool = False
) -> Spectrum:
    """``spectrum`` where it is known whether the period of the response has doubled.

    Then the odd multiples of half the frequency are taken out, as a foreign tone is.
    """
    time = time - time[0]
    interval = time[-1] / (time.size - 1)
    design = _design(time, interval, frequency, tone, doubled)
    # The columns are nearly orthogonal, so that the normal equations lose nothing.
    matrix = design.matrix
    inverse = np.linalg.inv(matrix.T @ matrix)
    solution = inverse @ (matrix.T @ channels.T)
    mean = design.read(solution).T
    residual = channels - (matrix @ solution).T
    parts = np.arange(1, PARTS * (design.harmonics + 1))
    parts = parts[parts % (PARTS // 2 if doubled else PARTS) > 0]
    turns = _turns(time, frequency / PARTS, int(parts[-1]))[parts - 1]
    # Lines closer than the record resolves say in part the same.
    same = max(1.0, PARTS / (frequency * time[-1]))
    left = 1.0 - _share(turns @ matrix, inverse) / time.size
    seen = left > LEAST_LEFT
    if tone is not None:
        seen = _unmixed(seen, frequency / PARTS * parts, frequency, tone, time[-1])
    lines = noise_psd.SpectralLines(frequency / PARTS * parts[seen], turns[seen], left[seen], same)
    level, coherence = noise_psd.levels(residual, lines)
    if abs(coherence) > SAME:
        mean, residual, level, coherence = mean[:1], residual[:1], level[:1], 0.0j
    at = frequency * np.arange(1, design.harmonics + 1)
    at = at if design.tone is None else np.r_[at, design.tone]
    return Spectrum(
        frequency,
        time.size * interval * frequency,
        time.size,
        interval,
        mean,
        np.array([design.scatter(inverse) * each.unbiased(at) for each in level]),
        coherence,
        residual,
        level,
        design.tone,
        design.masked,
        _alias_map(time, frequency, design, inverse),
    )


def _unmixed(
    seen: np.ndarray, lines: np.ndarray, frequency: float, tone: float, duration: float
) -> np.ndarray:
    """Which of the lines (Hz) that are seen lie beside those that a tone makes with the harmonics.

    Those of a weak tone do not stand out of the noise, and still add to it. All, if too few would be left.
    """
    away = np.minimum(_beside(lines - tone, frequency), _beside(lines + tone, frequency))
    clear = seen & (away * duration > TONE_LINE_WIDTH)
    return clear if clear.sum() > LEAST_CLEAR_SHARE * seen.sum() else seen


def _share(products: np.ndarray, inverse: np.ndarray) -> np.ndarray:
    """What a fit takes of some lines (m,), from their products with its columns (m, k)."""
    return ((products @ inverse) * products.conj()).sum(axis=1).real


def _alias_map(time: np.ndarray, frequency: float, design: "_Design", inverse: np.ndarray) -> AliasMap | None:
    """What harmonics up to FOLDED add to those that are read; None where they are all read as themselves."""
    if (SIMULATED + REMOVED) * frequency * time[-1] < time.size - 1:
        return None
    return alias_map(
        design.read(inverse @ design.matrix.T), _turns(time, frequency, SIMULATED), design.removed
    )


class _Design(NamedTuple):
    """Columns of a fit, and the places of the cosines and sines that are kept; a tone comes last."""

    matrix: np.ndarray
    cosines: np.ndarray
    sines: np.ndarray
    harmonics: int
    removed: int
    tone: float | None
    masked: int | None

    def read(self, solution: np.ndarray) -> np.ndarray:
        """Complex amplitudes (columns, ...) from a solution (2 + ..., ...)."""
        return solution[self.cosines] - 1j * solution[self.sines]

    def scatter(self, inverse: np.ndarray) -> np.ndarray:
        """Variance of each complex amplitude in white noise of variance 1."""
        variance = np.diag(inverse)
        return variance[self.cosines] + variance[self.sines]


def _design(
    time: np.ndarray, interval: float, frequency: float, tone: float | None, doubled: bool
) -> _Design:
    removed, kept = (within_band(most, frequency, interval) for most in (REMOVED, COMPARED))
    columns = [regressors(time, frequency, removed)]
    places = np.array([np.arange(2, 2 + kept), np.arange(2 + removed, 2 + removed + kept)])
    if doubled:
        half = _turns(time, 0.5 * frequency, 2 * kept + 1)[::2].T
        columns += [half.real, half.imag]
    told, masked = (False, None) if tone is None else tone_position(tone, frequency, time[-1], kept)
    if tone is not None and _beside(tone, frequency) * time[-1] > MINGLED:
        turn = np.exp(2j * pi * tone * time)[:, None]
        columns += [turn.real, turn.imag]
    matrix = np.concatenate(columns, axis=1)
    if told:
        places = np.c_[places, [matrix.shape[1] - 2, matrix.shape[1] - 1]]
    return _Design(matrix, places[0], places[1], kept, removed, tone if told else None, masked)
