"""A spurious (interharmonic) tone: one frequency that stands out between the harmonics of several tests."""

from collections.abc import Mapping, Sequence
from math import ceil, pi
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import gammaln, logsumexp, xlogy

from wedgesweep.diagnose.steady.harmonic_fit import BAND, REMOVED, regressors, resolvable, within_band
from wedgesweep.diagnose.steady.noise_psd import FALSE_ALARM
from wedgesweep.diagnose.steady.spectra import Spectrum

# The effect that makes one, and its number that the records tell directly.
TONE = "stray_vibration"
TONE_FREQUENCY = f"{TONE}.frequency_hz"
# Grid points per resolution of the longest record.
FINE = 4
# Lowest frequency (Hz) that is searched on a rig like the bench: anything slower is drift.
LOWEST = 1.0
# Share of a tone that must not be a harmonic for its power to count in full.
NOT_HARMONIC = 0.05
# Tests whose frequencies, or amplitudes, differ by less than this share have the same one.
SAME = 0.02
# Least curvature of the power over a step of the grid: below it the frequency is undetermined.
LEAST_CURVATURE = 1e-3


class Tone(NamedTuple):
    """Frequency of a spurious tone and its standard deviation (Hz)."""

    frequency: float
    std: float


def of(effects: Mapping[str, Mapping[str, float]]) -> Tone | None:
    """The tone that a model contains."""
    return Tone(effects[TONE]["frequency"], 0.0) if TONE in effects else None


def find(spectra: Sequence[Spectrum], lowest: float = LOWEST) -> Tone | None:
    """The tone from a lowest frequency (Hz) up that is common to all tests, None if there is none.

    Multiples of half, a third and so on of the input frequency are no spurious tones but sub-harmonics of
    the response; tests of another frequency have them elsewhere. If all tests have the same frequency, a
    tone cannot be told from half its multiples.
    """
    frequency = np.array([s.frequency for s in spectra])
    alike = np.abs(np.log(frequency / frequency[:, None])) < SAME
    longest = max(s.duration for s in spectra)
    highest = max(BAND / s.interval for s in spectra)
    grid = np.arange(lowest, highest, 1.0 / longest / FINE)
    if not grid.size:
        return None
    part = 2 if len(spectra) > 1 and alike.all() else 1
    resolved = np.array(
        [resolvable(grid, s.frequency / part, s.duration, part * (s.harmonics + 1) - 1) for s in spectra]
    )
    power = np.where(resolved, [s.excess_at(grid) for s in spectra], 0.0)
    count = np.array([[s.mean.shape[0]] for s in spectra]) * resolved
    log_p = _log_p_without_strongest(power, count, alike)
    best = int(np.argmin(log_p))
    if log_p[best] + np.log(grid.size) > np.log(FALSE_ALARM):
        return None
    seen = [JointFit(s) for s, one in zip(spectra, resolved[:, best], strict=True) if one]
    return _refined(seen, float(grid[best]), float(grid[1] - grid[0]))


def _log_p_without_strongest(power: np.ndarray, count: np.ndarray, alike: np.ndarray) -> np.ndarray:
    """Logarithm of the p-value (n,) of powers of ``count`` channels (T, n), without the tests that show most.

    A tone also makes intermodulation lines with the harmonics of one response, and a response has
    sub-harmonics: only tests of the same frequency, ``alike`` (T, T), share them. What counts is what the
    other tests show together, or one of them by itself; if all have one frequency, all but the strongest.
    """
    aside = np.eye(len(power), dtype=bool) if alike.all() else alike
    counting = ~aside[:, np.argmax(power, axis=0)] | (len(power) == 1)
    power, count = power * counting, count * counting
    one = np.argmax(power, axis=0)[None]
    single = log_p_value(*(np.take_along_axis(each, one, axis=0)[0] for each in (power, count)))
    return np.minimum(log_p_value(power.sum(axis=0), count.sum(axis=0)), single)


class JointFit:
    """One test fitted with harmonics and a tone at once, which does justice to a tone near a harmonic."""

    def __init__(self, spectrum: Spectrum) -> None:
        self.spectrum = spectrum
        self.time = np.arange(spectrum.samples) * spectrum.interval
        highest = within_band(REMOVED, spectrum.frequency, spectrum.interval)
        self.basis, _ = np.linalg.qr(regressors(self.time, spectrum.frequency, highest))

    def power(self, frequency: float) -> float:
        """Reduction of half the squared misfit by a tone (Hz), over all channels; about 1 each in noise."""
        turn = 2.0 * pi * frequency * self.time
        columns = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        columns -= self.basis @ (self.basis.T @ columns)
        size = columns.T @ columns + NOT_HARMONIC * 0.5 * self.time.size * np.eye(2)
        along = self.spectrum.residual @ columns
        squares = np.einsum("ci,ic->c", along, np.linalg.solve(size, along.T))
        level = [float(level(np.array(frequency))) for level in self.spectrum.level]
        return 0.5 * float((squares / level).sum())


def _refined(tests: Sequence[JointFit], frequency: float, step: float) -> Tone:
    """The tone of most power in the same tests, near one found on a grid of ``step`` (Hz).

    On the grid tests come and go as the tone passes their harmonics, which can shift the maximum to where
    one of them comes in. The power is a log-likelihood: its curvature at the maximum gives the standard
    deviation.
    """

    def power(frequency: float) -> float:
        return sum(test.power(frequency) for test in tests)

    reach = ceil(1.0 / min(test.time[-1] for test in tests) / step)
    near = frequency + step * np.arange(-reach, reach + 1)
    highest = max(near[near > 0.5 * frequency], key=power)
    refined = minimize_scalar(
        lambda f: -power(f),
        bounds=(highest - step, highest + step),
        method="bounded",
        options={"xatol": 1e-4 * step},
    )
    peak = float(refined.x)
    curvature = 2.0 * power(peak) - power(peak - step) - power(peak + step)
    return Tone(peak, float(step / np.sqrt(max(curvature, LEAST_CURVATURE))))


def between(spectra: Sequence[Spectrum]) -> float:
    """A frequency (Hz) that most tests resolve from their harmonics, closest to the middle of theirs."""
    middle = float(np.exp(np.mean([np.log(s.frequency) for s in spectra])))
    grid = middle * np.geomspace(0.5, 4.0, 400)
    resolving = np.array([s.resolves(grid) for s in spectra]).sum(axis=0)
    best = np.flatnonzero(resolving == resolving.max())
    return float(grid[best[np.argmin(np.abs(np.log(grid[best] / middle)))]])


def log_p_value(power: np.ndarray, count: np.ndarray) -> np.ndarray:
    """Logarithm of the probability that ``count`` unit exponentials (n,) add up to more than ``power`` (n,).

    Exact however small: scipy's ``gamma.logsf`` ends at -inf, where the peak of a strong tone looks flat.
    """
    orders = np.arange(max(count.max(), 1))
    terms = xlogy(orders, power[:, None]) - gammaln(orders + 1.0)
    terms[orders >= np.maximum(count, 1)[:, None]] = -np.inf
    return logsumexp(terms, axis=1) - power
