"""Measured signals as harmonics with their noise.

A forced response repeats each period, noise does not. One least-squares fit over the whole record gives the
harmonics, whatever the sampling rate; the residual between them gives the noise near each of them (after
Pintelon and Schoukens, System Identification, 2012, ch. 4).
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.special import gammaincc

from wedgesweep.diagnose.steady import noise_psd
from wedgesweep.diagnose.steady.harmonic_fit import (
    REMOVED,
    RESOLVED,
    DesignMatrix,
    design_matrix,
    distance,
    phasors_of,
    resolvable,
)
from wedgesweep.diagnose.steady.noise_psd import FALSE_ALARM, SmoothPSD
from wedgesweep.measured.cycles import SEEN

# Harmonics that are simulated, and whose aliases beyond half the sampling rate count.
SIMULATED = 127
# The noise is evaluated between harmonics, at multiples of this fraction of the input frequency.
PARTS = 8
# Lines of which less than this share remains after the fit are not used for the noise.
LEAST_REMAINING = 0.2
# Two channels whose noise is more coherent than this are the same signal.
SAME_SIGNAL = 0.98


class AliasMap(NamedTuple):
    """Aliases: what K harmonics D_k add to the amplitudes that a fit reads.

    A motion that sticks and slips has kinks, and so harmonics at all orders. Sampling shows those above half
    its rate at other frequencies; if the rate is nearly a multiple of the input's frequency, these are so
    close to lower harmonics that no record can separate them. (Slip pulses at 31.3 Hz, sampled 63.05 times a
    period at 4 % noise: 62 in chi-squared.) A low-pass filter ahead of the sampling removes them.

    ``direct`` and ``mirrored`` (columns, K): complex factors of D_k, and of their conjugates.
    """

    direct: np.ndarray
    mirrored: np.ndarray

    def __call__(self, harmonics: np.ndarray) -> np.ndarray:
        """What harmonics (..., C, K) at the first sample add to those that are read (..., C, columns)."""
        return harmonics @ self.direct.T + harmonics.conj() @ self.mirrored.T


@dataclass(frozen=True)
class Spectrum:
    """Harmonics of one test; channels are displacement x - y (m) and velocity x' - y' (m/s).

    Attributes
    ----------
    frequency, periods, samples, interval
        Input frequency (Hz), length in its periods, number of samples and their interval (s).
    mean : ndarray, shape (channels, harmonics)
        Complex: signal = Re sum D_h exp(i h omega t) from the first sample.
    variance : ndarray, shape (channels, harmonics)
        Of one such complex number, real and imaginary part together.
    coherence : complex
        Of the noise of both channels.
    residual : ndarray, shape (channels, n)
        The record without harmonics.
    level : tuple of SmoothPSD
        Noise of each channel.
    tone : float or None
        Frequency (Hz) of a spurious tone, whose complex amplitude is the last column of ``mean``.
    masked_harmonic : int or None
        The harmonic (1, 2, ...) that the record cannot resolve from a tone; it is not compared.
    alias_map : AliasMap or None
        What harmonics above half the sampling rate add to ``mean``, None for nothing.
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
    masked_harmonic: int | None = None
    alias_map: AliasMap | None = None

    @property
    def duration(self) -> float:
        """Length of the record in s."""
        return self.samples * self.interval

    @property
    def observations(self) -> int:
        """Real numbers that are compared."""
        return 2 * (self.mean.size - (self.masked_harmonic is not None) * self.mean.shape[0])

    @property
    def has_tone(self) -> bool:
        """Whether a spurious tone shows, by itself or merged with a harmonic."""
        return self.tone is not None or self.masked_harmonic is not None

    @property
    def sample_noise(self) -> np.ndarray:
        """Noise of one sample (channels,), in m and m/s."""
        return np.sqrt(self.variance.mean(axis=1) * self.samples / 4.0)

    @property
    def rms(self) -> np.ndarray:
        """Of the harmonics of each channel (channels,)."""
        return np.sqrt(0.5 * (np.abs(self.mean[:, : self.harmonics]) ** 2).sum(axis=1))

    @property
    def seen(self) -> tuple[int, ...]:
        """Harmonics of the first channel that stand out of the noise."""
        power = np.abs(self.mean[0, : self.harmonics]) ** 2
        return tuple((np.flatnonzero(power > SEEN * self.variance[0, : self.harmonics]) + 1).tolist())

    @property
    def harmonics(self) -> int:
        """Number of harmonics, a tone not counted."""
        return self.mean.shape[1] - (self.tone is not None)

    def excess_at(self, frequencies: np.ndarray) -> np.ndarray:
        """Power at some frequencies (Hz) over the smoothed PSD, summed over channels.

        In noise it is 1 for each channel on average.
        """
        padded = 8 * self.samples
        transform = np.fft.rfft(self.residual, padded, axis=1)
        # Bins beyond the record's band are not used.
        bins = np.minimum(np.round(frequencies * self.interval * padded).astype(int), padded // 2)
        power = np.abs(transform[:, bins]) ** 2 / self.samples
        return sum(each / level(frequencies) for each, level in zip(power, self.level, strict=True))

    def with_undetected_tone(self, frequency: float) -> "Spectrum":
        """The spectrum as if a tone had been looked for at a frequency (Hz), and only noise been found."""
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
        """Whether the record resolves these frequencies from the harmonics, in the band of those compared."""
        return resolvable(frequencies, self.frequency, self.duration, self.harmonics)


def spectrum(time: np.ndarray, channels: np.ndarray, frequency: float, tone: float | None = None) -> Spectrum:
    """Harmonics of one test, also of a response that repeats only every other period.

    Parameters
    ----------
    time : ndarray, shape (n,)
        In s, evenly spaced.
    channels : ndarray, shape (channels, n)
        Displacement (m) and velocity (m/s), if measured.
    frequency : float
        Of the input, in Hz.
    tone : float, optional
        Frequency (Hz) of a spurious tone.
    """
    once = fitted(time, channels, frequency, tone)
    return fitted(time, channels, frequency, tone, doubled=True) if _doubled(once, tone) else once


def _doubled(spectrum: Spectrum, tone: float | None) -> bool:
    """Whether a response repeats only every other period: odd multiples of half the frequency stand out.

    The strongest of them does not count, as it may be a spurious tone. If a known tone cannot be resolved
    from one of them, what stands out is attributed to the tone.
    """
    if tone is not None and distance(tone, 0.5 * spectrum.frequency) * spectrum.duration <= RESOLVED:
        return False
    odd = np.arange(1, 2 * spectrum.harmonics + 2, 2)
    power = np.sort(spectrum.excess_at(0.5 * spectrum.frequency * odd))[:-1]
    return bool(gammaincc(power.size * spectrum.mean.shape[0], power.sum()) < FALSE_ALARM)


def fitted(
    time: np.ndarray, channels: np.ndarray, frequency: float, tone: float | None = None, doubled: bool = False
) -> Spectrum:
    """Harmonics of a response whose period is known to be doubled or not; see ``spectrum``.

    Odd multiples of half the frequency are removed if it is, as a tone is.
    """
    time = time - time[0]
    interval = time[-1] / (time.size - 1)
    design = design_matrix(time, interval, frequency, tone, doubled)
    # The columns are nearly orthogonal, so the normal equations lose no accuracy.
    matrix = design.matrix
    inverse = np.linalg.inv(matrix.T @ matrix)
    solution = inverse @ (matrix.T @ channels.T)
    mean = design.read(solution).T
    residual = channels - (matrix @ solution).T
    lines = _noise_lines(time, frequency, design, inverse, doubled)
    level, coherence = noise_psd.levels(residual, lines)
    if abs(coherence) > SAME_SIGNAL:
        mean, residual, level, coherence = mean[:1], residual[:1], level[:1], 0.0j
    at = frequency * np.arange(1, design.harmonics + 1)
    at = at if design.tone is None else np.r_[at, design.tone]
    return Spectrum(
        frequency=frequency,
        periods=time.size * interval * frequency,
        samples=time.size,
        interval=interval,
        mean=mean,
        variance=np.array([design.scatter(inverse) * each.unbiased(at) for each in level]),
        coherence=coherence,
        residual=residual,
        level=level,
        tone=design.tone,
        masked_harmonic=design.masked_harmonic,
        alias_map=_alias_map(time, frequency, design, inverse),
    )


def _noise_lines(
    time: np.ndarray,
    frequency: float,
    design: DesignMatrix,
    inverse: np.ndarray,
    doubled: bool,
) -> noise_psd.SpectralLines:
    """Lines between the harmonics at which the residual of a fit is noise."""
    parts = np.arange(1, PARTS * (design.harmonics + 1))
    parts = parts[parts % (PARTS // 2 if doubled else PARTS) > 0]
    phasors = phasors_of(time, frequency / PARTS, int(parts[-1]))[parts - 1]
    # Lines closer than the resolution of the record are partly redundant.
    redundancy = max(1.0, PARTS / (frequency * time[-1]))
    remaining = 1.0 - _absorbed(phasors @ design.matrix, inverse) / time.size
    seen = remaining > LEAST_REMAINING
    return noise_psd.SpectralLines(
        frequency / PARTS * parts[seen], phasors[seen], remaining[seen], redundancy
    )


def _absorbed(products: np.ndarray, inverse: np.ndarray) -> np.ndarray:
    """Power (m,) of unit lines that a fit absorbs, from their products (m, k) with its columns."""
    return ((products @ inverse) * products.conj()).sum(axis=1).real


def _alias_map(
    time: np.ndarray, frequency: float, design: DesignMatrix, inverse: np.ndarray
) -> AliasMap | None:
    """Aliases of harmonics up to SIMULATED; None if the record shows all of them as themselves."""
    if (SIMULATED + REMOVED) * frequency * time[-1] < time.size - 1:
        return None
    phasors = phasors_of(time, frequency, SIMULATED)
    read = design.read(inverse @ design.matrix.T)
    direct, mirrored = 0.5 * read @ phasors.T, 0.5 * read @ phasors.conj().T
    # The harmonics that are part of the fit have no aliases.
    direct[:, : design.removed] = mirrored[:, : design.removed] = 0.0
    return AliasMap(direct, mirrored)
