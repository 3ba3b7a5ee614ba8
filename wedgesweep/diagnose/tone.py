"""A foreign tone: one frequency that stands out between the harmonics of several tests."""

from collections.abc import Sequence
from math import pi
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import gammaln, logsumexp, xlogy

from wedgesweep.diagnose.spectra import BAND, Spectrum

# Chance of a tone where there is only noise.
CHANCE = 1e-4
# Grid points per resolution of the longest record.
FINE = 4
# Lowest frequency (Hz) that is looked at: slower than that is drift.
LOWEST = 1.0
# A tone stands out in at least this many tests.
SEVERAL = 2


class Tone(NamedTuple):
    """Frequency of a foreign tone and its standard deviation (Hz)."""

    frequency: float
    std: float


def find(spectra: Sequence[Spectrum]) -> Tone | None:
    """The tone common to all tests, None where there is none.

    Multiples of half, a third and so on of the input frequency are no foreign tones but sub-harmonics
    of the response; they lie elsewhere in each test, unless all tests have one frequency.
    """
    longest = max(s.samples * s.interval for s in spectra)
    highest = min(BAND / s.interval for s in spectra)
    grid = np.arange(LOWEST, highest, 1.0 / longest / FINE)
    power = np.array([_power(s, grid) for s in spectra])
    channels = np.array([s.mean.shape[0] for s in spectra])
    separated = np.array([s.separates(grid) for s in spectra])
    chance = log_chance(power.sum(axis=0), (channels[:, None] * separated).sum(axis=0))
    best = int(np.argmin(chance))
    standing_out = log_chance(power[:, best], channels) < np.log(1e-3)
    if chance[best] + np.log(grid.size) > np.log(CHANCE) or standing_out.sum() < min(SEVERAL, len(spectra)):
        return None
    step = grid[1] - grid[0]
    seen = [s for s, one in zip(spectra, separated[:, best], strict=True) if one]
    refined = minimize_scalar(
        lambda f: -sum(s.exact_excess_at(np.array([f]))[0] for s in seen),
        bounds=(grid[best] - step, grid[best] + step),
        method="bounded",
        options={"xatol": 1e-4 * step},
    )
    return Tone(float(refined.x), _std(seen, float(refined.x)))


def between(spectra: Sequence[Spectrum]) -> float:
    """A frequency (Hz) that most tests tell from their harmonics, closest to the middle of theirs."""
    middle = float(np.exp(np.mean([np.log(s.frequency) for s in spectra])))
    grid = middle * np.geomspace(0.5, 4.0, 400)
    telling = np.array([s.separates(grid) for s in spectra]).sum(axis=0)
    best = np.flatnonzero(telling == telling.max())
    return float(grid[best[np.argmin(np.abs(np.log(grid[best] / middle)))]])


def _std(spectra: Sequence[Spectrum], frequency: float) -> float:
    """Least standard deviation of a tone's frequency (Rife and Boorstyn, 1974), all tests together."""
    durations = np.array([s.samples * s.interval for s in spectra])
    power = np.array([s.exact_excess_at(np.array([frequency]))[0] for s in spectra])
    return float(np.sqrt(6.0 / (power @ durations**2)) / (2.0 * pi))


def log_chance(power: np.ndarray, count: np.ndarray) -> np.ndarray:
    """Logarithm of the chance that ``count`` unit exponentials (n,) add up to more than ``power`` (n,).

    Exact however small: scipy's ``gamma.logsf`` ends at -inf, where a strong tone's peak looks flat.
    """
    orders = np.arange(max(count.max(), 1))
    terms = xlogy(orders, power[:, None]) - gammaln(orders + 1.0)
    terms[orders >= np.maximum(count, 1)[:, None]] = -np.inf
    return logsumexp(terms, axis=1) - power


def _power(spectrum: Spectrum, frequencies: np.ndarray) -> np.ndarray:
    """Power over the noise, 0 where a harmonic is too close."""
    return np.where(spectrum.separates(frequencies), spectrum.excess_at(frequencies), 0.0)
