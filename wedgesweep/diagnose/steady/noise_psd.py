"""Power spectral density of the noise of a record, from what does not repeat, and coherence of its channels.

No noise model is assumed except that the spectrum is smooth (after Pintelon and Schoukens, System
Identification, 2012, ch. 4).
"""

from math import log
from typing import NamedTuple

import numpy as np

# Order of the polynomial in log frequency that describes the logarithm of the noise spectrum.
ORDER = 3
# A spectral line this many times above the smoothed PSD is not noise (probability 1e-5 in noise).
OUTLIER = 11.5
# Probability of a false alarm in noise: of a tone, of a response that repeats only every other period, or of
# a coherence of channels.
FALSE_ALARM = 1e-4


class SmoothPSD:
    """A PSD whose logarithm is a polynomial in the logarithm of frequency.

    ``covariance`` (n, n): of its coefficients, if they are estimates.
    """

    def __init__(
        self, coefficients: np.ndarray, reference: float, covariance: np.ndarray | None = None
    ) -> None:
        self.coefficients, self.reference = coefficients, reference
        self.covariance = np.zeros((coefficients.size,) * 2) if covariance is None else covariance

    def __call__(self, frequency: np.ndarray) -> np.ndarray:
        return np.exp(self._powers(frequency) @ self.coefficients)

    def unbiased(self, frequency: np.ndarray) -> np.ndarray:
        """Level by which squares of the same noise average to 1.

        The reciprocal of an estimate is too large on average, by the estimate's relative variance.
        """
        powers = self._powers(frequency)
        return self(frequency) * (1.0 + ((powers @ self.covariance) * powers).sum(axis=-1))

    def _powers(self, frequency: np.ndarray) -> np.ndarray:
        return np.log(frequency / self.reference)[..., None] ** np.arange(self.coefficients.size)


class SpectralLines(NamedTuple):
    """The m frequencies at which the noise is evaluated.

    ``frequency`` (m,) in Hz; ``phasors`` (m, n): exp(2 pi i f t) at the samples. ``remaining`` (m,): share of
    white noise that remains after the harmonics were removed. ``redundancy``: number of lines that count as
    one, as neighbours are correlated.
    """

    frequency: np.ndarray
    phasors: np.ndarray
    remaining: np.ndarray
    redundancy: float


def levels(residual: np.ndarray, lines: SpectralLines) -> tuple[tuple[SmoothPSD, ...], complex]:
    """Smoothed PSD of each channel of a residual (channels, n), and the coherence of the channels."""
    power, product = _periodograms(residual, lines)
    level = tuple(_smoothed(lines.frequency, each, lines.redundancy) for each in power)
    if len(level) == 1:
        return level, 0.0j
    smooth = np.array([each(lines.frequency) for each in level])
    # A line that stands out in either channel is not noise.
    kept = (power <= OUTLIER * smooth).all(axis=0)
    return level, _coherence(product[kept] / np.sqrt(smooth[:, kept].prod(axis=0)))


def _periodograms(residual: np.ndarray, lines: SpectralLines) -> tuple[np.ndarray, np.ndarray]:
    """Power of each channel (channels, m), and product of the last one with the first, conjugate (m,).

    Both are corrected for what the removal of the harmonics took of the noise.
    """
    transform = residual @ lines.phasors.conj().T
    size = residual.shape[1] * lines.remaining
    return np.abs(transform) ** 2 / size, transform[-1] * transform[0].conj() / size


def _smoothed(frequency: np.ndarray, power: np.ndarray, redundancy: float) -> SmoothPSD:
    """Maximum-likelihood fit to powers (m,) that scatter exponentially about a smooth spectrum.

    Lines that stand out are left out, and the rest is fitted again.
    """
    reference = float(np.sqrt(frequency[0] * frequency[-1]))
    design = np.polynomial.polynomial.polyvander(np.log(frequency / reference), ORDER)
    kept = np.ones(frequency.size, bool)
    tiny = np.finfo(float).tiny
    coefficients = np.zeros(ORDER + 1)
    for _ in range(4):
        coefficients[:] = 0.0
        coefficients[0] = np.log(power[kept].mean() + tiny)
        for _ in range(30):
            ratio = power[kept] / np.exp(design[kept] @ coefficients)
            change = np.linalg.solve(design[kept].T @ design[kept], design[kept].T @ (ratio - 1.0))
            coefficients += np.clip(change, -1.0, 1.0)
            if np.abs(change).max() < 1e-10:
                break
        stands_out = power > OUTLIER * np.exp(design @ coefficients)
        if (kept == ~stands_out).all():
            break
        kept = ~stands_out
    return SmoothPSD(coefficients, reference, redundancy * np.linalg.inv(design[kept].T @ design[kept]))


def _coherence(products: np.ndarray) -> complex:
    """Mean of normalised products (m,) of two channels' noise; 0 if it is not significant."""
    value = complex(products.mean())
    return value if abs(value) ** 2 * products.size > -log(FALSE_ALARM) else 0.0j
