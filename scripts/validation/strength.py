"""How strongly a hidden effect shows: the excess chi-squared it causes, estimated without noise.

The estimate is the least sum of squared differences between true and simulated harmonics, over the variance
of the noise. Fitted are the start phase and the input amplitude of each test and the uncertain parameters
of the model, as a diagnosis has to.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from scipy.optimize import least_squares

from validation import response
from validation.response import HARMONICS, TONE, Effects, System, Test
from wedgesweep.effects import merge
from wedgesweep.synthesize.noise import AR1_CORRELATION
from wedgesweep.uncertain import uncertain_numbers

# Length of a record in periods, its sampling rate, and the noise over the rms of a channel.
PERIODS, SAMPLING_HZ, LEVEL = 8.4, 2000.0, 0.04
# A smaller displacement over that by a static input counts as sticking.
STUCK = 1e-3
# Steps of log amplitudes and of uncertain numbers in finite differences.
STEP = 1e-4
# An estimate need not be better than this share. Uncertain numbers that together make up for a cause take
# many evaluations to get there, and an estimate that stops before is far too high.
FTOL, EVALUATIONS = 1e-2, 40
# Residual that stands for a response that does not exist.
ABSENT = 1e3
START_PHASES = 256
# Strengths at which `reach` looks first, its iterations, and how close log(excess) must come.
COARSE, BISECTIONS, LOG_TOLERANCE = 13, 14, 0.2


@dataclass(frozen=True)
class Bench:
    """How a system is tested: tests, kind of noise, and what is uncertain.

    ``spread`` is the relative std of the stated input amplitudes, None where they are unknown;
    ``uncertain`` that of numbers of the model by effect; ``model_error`` what a model may be wrong by.
    """

    tests: Sequence[Test]
    noise: str
    spread: float | None
    uncertain: Mapping[str, float]
    sampling_hz: float = SAMPLING_HZ
    model_error: float = 0.0

    @property
    def frequencies(self) -> np.ndarray:
        return np.array([test.frequency_hz for test in self.tests])

    @property
    def channels(self) -> int:
        """A velocity that is differentiated from the displacement adds no information."""
        return 1 if self.noise == "differentiated" else 2

    def noise_std(self, true: np.ndarray, tone_hz: float) -> np.ndarray:
        """Std of the real part of each harmonic, by noise and model error, of the shape of ``true``."""
        rms = np.sqrt(0.5 * (np.abs(true) ** 2).sum(axis=-1, keepdims=True))
        std = LEVEL * rms * (0.5 if self.noise == "adc" else 1.0)
        orders = np.arange(1, HARMONICS + 1)
        at = np.column_stack([self.frequencies[:, None] * orders, np.full(len(self.tests), tone_hz)])
        samples = PERIODS / self.frequencies * self.sampling_hz
        power = _spectral_shape(at, self.noise, self.sampling_hz) * (2.0 / samples)[:, None]
        return np.hypot(std * np.sqrt(power)[:, None], self.model_error * rms / np.sqrt(HARMONICS))


def _spectral_shape(frequency: np.ndarray, noise: str, sampling_hz: float) -> np.ndarray:
    """Power of the noise over that of white noise of the same variance."""
    if noise != "ar1":
        return np.ones_like(frequency)
    r, angle = AR1_CORRELATION, 2.0 * pi * frequency / sampling_hz
    return (1.0 - r * r) / (1.0 - 2.0 * r * np.cos(angle) + r * r)


def true_spectra(system: System, tests: Sequence[Test]) -> np.ndarray | None:
    """Spectra of the true system, see ``response.spectra``; None if one does not exist or does not move."""
    found = response.spectra(system, tests)
    inputs = system.rig.deflection * np.array([test.amplitude for test in tests])
    moves = np.abs(found[:, 0, 0]) > STUCK * inputs  # False for NaN
    return found if moves.all() else None


def tone_of(effects: Effects) -> float:
    """Frequency (Hz) of a stray tone; 0 without one, where nothing depends on it."""
    return effects[TONE]["frequency_hz"] if TONE in effects else 0.0


def excess(true: np.ndarray | None, tone_hz: float, model: System, bench: Bench) -> float:
    """Excess chi-squared that a model leaves of true responses; infinite where a response does not exist."""
    if true is None:
        return np.inf
    fit = _Fit(true[:, : bench.channels], tone_hz, model, bench)
    start = fit.start()
    if start is None:
        return np.inf
    best = least_squares(fit.residuals, start, fit.jacobian, x_scale="jac", ftol=FTOL, max_nfev=EVALUATIONS)
    return 2.0 * float(best.cost)


class _Fit:
    """Residuals over start phases (rad), log amplitudes and uncertain numbers less what is stated."""

    def __init__(self, true: np.ndarray, tone_hz: float, model: System, bench: Bench) -> None:
        self.true, self.model, self.bench = true, model, bench
        self.std = bench.noise_std(true, tone_hz)
        spread = np.inf if bench.spread is None else bench.spread
        unknown = {name: std for name, std in bench.uncertain.items() if name not in model.effects}
        self.uncertain = uncertain_numbers(unknown, {})
        self.prior = np.r_[np.full(len(bench.tests), spread), self.uncertain.std]

    def start(self) -> np.ndarray | None:
        """Nominal amplitudes and parameters, and the start phases that suit them best."""
        simulated = self.simulate(np.zeros(self.prior.size))
        if np.isnan(simulated).any():
            return None
        overlap = (self.true * simulated.conj() / self.std**2).sum(axis=1)[:, :HARMONICS]
        phases = np.linspace(-pi, pi, START_PHASES, endpoint=False)
        turn = np.exp(-1j * np.outer(np.arange(1, HARMONICS + 1), phases))
        return np.r_[phases[np.argmax((overlap @ turn).real, axis=1)], np.zeros(self.prior.size)]

    def simulate(self, x: np.ndarray) -> np.ndarray:
        """Spectra of the model at log amplitudes and uncertain numbers."""
        count, uncertain = len(self.bench.tests), self.uncertain
        changed = uncertain.by_key(np.maximum(uncertain.mean + x[count:], uncertain.low))
        effects = merge(self.model.effects, changed)
        tests = [
            test._replace(amplitude=test.amplitude * float(np.exp(step)))
            for test, step in zip(self.bench.tests, x[:count], strict=True)
        ]
        return response.spectra(self.model._replace(effects=effects), tests)[:, : self.bench.channels]

    def differences(self, phase: np.ndarray, simulated: np.ndarray) -> np.ndarray:
        """Whitened differences of each test, shape (tests, n)."""
        orders = np.r_[np.arange(1, HARMONICS + 1), 0]  # the phase of a tone is not compared
        turned = simulated * np.exp(1j * phase[:, None] * orders)[:, None]
        found = ((self.true - turned) / self.std).reshape(phase.size, -1)
        return np.nan_to_num(np.concatenate([found.real, found.imag], axis=-1), nan=ABSENT)

    def residuals(self, x: np.ndarray) -> np.ndarray:
        count = len(self.bench.tests)
        found = self.differences(x[:count], self.simulate(x[count:]))
        return np.r_[found.ravel(), x[count:] / self.prior]

    def jacobian(self, x: np.ndarray) -> np.ndarray:
        """Finite differences; phases and amplitudes act on their own test only."""
        count, rest = len(self.bench.tests), x[len(self.bench.tests) :]
        simulated = self.simulate(rest)
        base = self.differences(x[:count], simulated)
        rows = np.zeros((x.size, *base.shape))  # parameter, test, difference
        own = np.arange(count)
        rows[own, own] = (self.differences(x[:count] + STEP, simulated) - base) / STEP
        louder = self.simulate(rest + STEP * (np.arange(rest.size) < count))
        rows[count + own, own] = (self.differences(x[:count], louder) - base) / STEP
        for i in range(count, rest.size):
            other = self.simulate(rest + STEP * (np.arange(rest.size) == i))
            rows[count + i] = (self.differences(x[:count], other) - base) / STEP
        prior = np.hstack([np.zeros((rest.size, count)), np.diag(1.0 / self.prior)])
        return np.vstack([rows.reshape(x.size, -1).T, prior])


def reach(target: float, excess_at: Callable[[float], float]) -> float | None:
    """Strength between 0 and 1 at which the excess is the target, None where it never is.

    The excess need not increase monotonically: the first crossing from below counts.
    """
    last, low = 0.0, 0.0
    for strength in np.linspace(0.0, 1.0, COARSE).tolist():
        found = excess_at(strength)
        if found > target:
            return None if strength == 0.0 else _bisect(target, excess_at, low, strength)
        last, low = found, strength
    return low if last > np.exp(-LOG_TOLERANCE) * target else None


def _bisect(target: float, excess_at: Callable[[float], float], low: float, high: float) -> float | None:
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        found = excess_at(middle)
        if abs(np.log(max(found, 1e-300) / target)) < LOG_TOLERANCE:
            return middle
        low, high = (middle, high) if found < target else (low, middle)
    # The response jumps, from a smaller excess to a larger one.
    return None
