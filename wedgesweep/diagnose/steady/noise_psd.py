"""The noise of a record, from what does not repeat: its smooth spectrum, and the coherence of both channels.

No noise model is assumed but that the spectrum is smooth (after Pintelon and Schoukens, System
Identification, 2012, ch. 4).
"""

from typing import NamedTuple

import numpy as np

# Order of the polynomial, in log frequency, that the logarithm of the noise spectrum follows.
ORDER = 3
# A line this many times above the smooth noise is something else (odds of 1e-5 in noise).
FOREIGN = 11.5


class SmoothPSD:
    """A noise spectrum whose logarithm is a polynomial in the logarithm of frequency.

    ``covariance`` (n, n): of its coefficients, where they are estimates.
    """

    def __init__(
        self, coefficients: np.ndarray, reference: float, covariance: np.ndarray | None = None
    ) -> None:
        self.coefficients, self.reference = coefficients, reference
        self.covariance = np.zeros((coefficients.size,) * 2) if covariance is None else covariance

    def __call__(self, frequency: np.ndarray) -> np.ndarray:
        return np.exp(self._powers(frequency) @ self.coefficients)

    def unbiased(self, frequency: np.ndarray) -> np.ndarray:
        """Level by which squares of the same noise are 1 on average.

        One over an estimate is too large on average, by the estimate's relative variance.
        """
        powers = self._powers(frequency)
        return self(frequency) * (1.0 + ((powers @ self.covariance) * powers).sum(axis=-1))

    def _powers(self, frequency: np.ndarray) -> np.ndarray:
        return np.log(frequency / self.reference)[..., None] ** np.arange(self.coefficients.size)


class SpectralLines(NamedTuple):
    """Where the noise is looked at: ``frequency`` (m,) in Hz, and exp(2 pi i f t) there, ``turns`` (m, n).

    ``left`` (m,): share of white noise that is still there, as harmonics close by were taken out.
    ``same``: so many lines say what one does.
    """

    frequency: np.ndarray
    turns: np.ndarray
    left: np.ndarray
    same: float


def levels(residual: np.ndarray, lines: SpectralLines) -> tuple[tuple[SmoothPSD, ...], complex]:
    """Smooth noise of each channel of what is left of a record (channels, n), and their coherence."""
    power, product = _periodograms(residual, lines)
    level = tuple(_smooth(lines.frequency, each, lines.same) for each in power)
    if len(level) == 1:
        return level, 0.0j
    smooth = np.array([each(lines.frequency) for each in level])
    # A line that stands out in either channel is no noise.
    kept = (power <= FOREIGN * smooth).all(axis=0)
    return level, _coherence(product[kept] / np.sqrt(smooth[:, kept].prod(axis=0)))


def _periodograms(residual: np.ndarray, lines: SpectralLines) -> tuple[np.ndarray, np.ndarray]:
    """Power of each channel (channels, m) and product of the first two (m,), of all the noise."""
    transform = residual @ lines.turns.conj().T
    size = residual.shape[1] * lines.left
    return np.abs(transform) ** 2 / size, transform[-1] * transform[0].conj() / size


def _smooth(lines: np.ndarray, power: np.ndarray, same: float) -> SmoothPSD:
    """Maximum likelihood for powers that scatter exponentially around a smooth spectrum.

    Lines that stand out are left out and the rest is fitted again. ``same``: lines that say what one does.
    """
    reference = float(np.sqrt(lines[0] * lines[-1]))
    design = np.polynomial.polynomial.polyvander(np.log(lines / reference), ORDER)
    kept = np.ones(lines.size, bool)
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
        stands_out = power > FOREIGN * np.exp(design @ coefficients)
        if (kept == ~stands_out).all():
            break
        kept = ~stands_out
    return SmoothPSD(coefficients, reference, same * np.linalg.inv(design[kept].T @ design[kept]))


def _coherence(products: np.ndarray) -> complex:
    """Mean of products (m,) of two channels' noise over its levels; 0 where it is no more than chance."""
    value = complex(products.mean())
    return value if abs(value) ** 2 * products.size > 9.0 else 0.0j
