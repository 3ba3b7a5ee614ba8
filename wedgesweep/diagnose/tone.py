"""A foreign tone: one frequency that stands out between the harmonics of several tests."""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.stats import gamma

from wedgesweep.diagnose.spectra import BAND, Spectrum

# Chance of a tone where there is only noise.
CHANCE = 1e-4
# Grid points per resolution of the longest record.
FINE = 4
# Lowest frequency (Hz) that is looked at: slower than that is drift.
LOWEST = 1.0
# A tone stands out in at least this many tests.
SEVERAL = 2


def find(spectra: Sequence[Spectrum]) -> float | None:
    """Frequency (Hz) of a tone common to all tests, None where there is none.

    Multiples of half, a third and so on of the input frequency are no foreign tones but sub-harmonics
    of the response; they lie elsewhere in each test, unless all tests have one frequency.
    """
    longest = max(s.samples * s.interval for s in spectra)
    highest = min(BAND / s.interval for s in spectra)
    grid = np.arange(LOWEST, highest, 1.0 / longest / FINE)
    power = np.array([_power(s, grid) for s in spectra])
    channels = np.array([s.mean.shape[0] for s in spectra])
    separated = np.array([s.separates(grid) for s in spectra])
    chance = gamma.logsf(power.sum(axis=0), np.maximum((channels[:, None] * separated).sum(axis=0), 1))
    best = int(np.argmin(chance))
    standing_out = gamma.logsf(power[:, best], channels) < np.log(1e-3)
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
    return float(refined.x)


def _power(spectrum: Spectrum, frequencies: np.ndarray) -> np.ndarray:
    """Power over the noise, 0 where a harmonic is too close."""
    return np.where(spectrum.separates(frequencies), spectrum.excess_at(frequencies), 0.0)
