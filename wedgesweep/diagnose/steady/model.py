"""A hypothesis on the tests of a problem: what it simulates at a point, and how far that is from the data.

Unknown are the numbers of the hypothesis, the uncertain numbers of the model with their priors, and of
each test its start phase and its input amplitude. Phases have a closed way out (``FitData.start_phase``).
"""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.special import chdtrc

from wedgesweep.diagnose.fit_parameters import Hypothesis, Values
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.fit_data import FitData, real
from wedgesweep.diagnose.steady.spectra import SIMULATED
from wedgesweep.diagnose.steady.tone import TONE
from wedgesweep.effects import acting
from wedgesweep.solvers.periodic import Warm, at_rest, joined

# Standard deviations by which an uncertain number is well off.
OFF = 1.5
# A record was low-passed before it was sampled if that takes this much off Q.
FILTERED = 1.0
# A bolster that moves less than this share of what was measured sticks.
STICKS = 0.01
# An exactly known amplitude, as a relative standard deviation.
EXACT = 1e-6


@dataclass(frozen=True)
class Point:
    """A guess: numbers ``x`` (k + u,) of hypothesis and uncertain model, ``amplitude`` (T,) in logarithm.

    ``tone_phase`` (T,): phase (rad) of the vibration behind a foreign tone, NaN where it is not known: see
    meeting.py.
    """

    x: np.ndarray
    amplitude: np.ndarray
    tone_phase: np.ndarray
    warm: Warm

    def moved(self, numbers: np.ndarray, local: np.ndarray) -> "Point":
        """After steps of the numbers (k,) and of what is local to tests (T, L): amplitude, ``tone_phase``."""
        tone_phase = self.tone_phase + local[..., 1] if local.shape[-1] > 1 else self.tone_phase
        return replace(
            self, x=self.x + numbers, amplitude=self.amplitude + local[..., 0], tone_phase=tone_phase
        )


@dataclass(frozen=True)
class Evaluation:
    """A simulated point: whitened harmonics (T, C, H), their rotation (T,) and what is left.

    ``aliases`` (T, C, H) are those of harmonics above half the sampling rate, 0 in a record that looks as if
    it had been low-passed before it was sampled.
    """

    point: Point
    whitened: np.ndarray
    harmonics: np.ndarray
    phase: np.ndarray
    aliases: np.ndarray
    residual: np.ndarray
    prior: np.ndarray
    found_tests: np.ndarray

    @property
    def found(self) -> bool:
        return bool(self.found_tests.all())

    @property
    def aliased(self) -> np.ndarray:
        """Whether (T, 1, 1) images are part of what is compared."""
        return (self.aliases != 0.0).any(axis=(-2, -1), keepdims=True)

    @cached_property
    def chi2_by_test(self) -> np.ndarray:
        """Squared misfit of each test, its amplitude's prior included (T,)."""
        return (self.residual**2).sum(-1) + self.prior[: len(self.residual)] ** 2

    @cached_property
    def chi2(self) -> float:
        return float((self.residual**2).sum() + (self.prior**2).sum()) if self.found else np.inf


def best_evaluation_per_test(evaluations: Sequence[Evaluation]) -> np.ndarray:
    """Which of some trials leaves least of each test, (T,)."""
    misfit = [np.where(each.found_tests, each.chi2_by_test, np.inf) for each in evaluations]
    return np.argmin(misfit, axis=0)


@dataclass(frozen=True)
class Fit:
    """Where a fit ended; ``covariance`` (k + u, k + u) is that of ``evaluation.point.x``."""

    model: "Model"
    evaluation: Evaluation
    covariance: np.ndarray
    converged: bool

    @property
    def effects(self) -> tuple[str, ...]:
        return self.model.hypothesis.effects

    @property
    def chi2(self) -> float:
        return self.evaluation.chi2

    @property
    def dof(self) -> int:
        return self.model.dof

    @property
    def excess(self) -> float:
        return self.chi2 - self.dof

    @property
    def x(self) -> np.ndarray:
        return self.evaluation.point.x

    @property
    def p(self) -> float:
        """Probability of a misfit this large if the model is right."""
        return float(chdtrc(self.dof, self.chi2))

    @property
    def values(self) -> Values:
        """Numbers of the hypothesis in key units."""
        return self.model.hypothesis.in_key_units(self.x[: self.model.size])

    def amplitudes(self) -> np.ndarray:
        """Input amplitudes (T,) in m."""
        return self.model.reference * np.exp(self.evaluation.point.amplitude)


class Model:
    """A hypothesis on the tests of a problem: simulates to a tolerance, and knows what is free."""

    def __init__(
        self,
        data: FitData,
        hypothesis: Hypothesis,
        reference: np.ndarray,
        tolerance: float = simulation.TOLERANCE,
    ) -> None:
        self.data, self.hypothesis, self.reference = data, hypothesis, reference
        self.tolerance = tolerance
        self.size = len(hypothesis.parameters)
        self.has_tone = data.tone is not None and TONE in {
            *acting(data.model.effects),
            *hypothesis.effects,
        }
        # A candidate effect is no nuisance at the same time: it is free of its prior.
        self.uncertain = {k: s for k, s in data.uncertain.items() if k not in hypothesis.effects}
        self.low = np.r_[hypothesis.low, [0.2] * len(self.uncertain)]
        self.high = np.r_[hypothesis.high, [5.0] * len(self.uncertain)]
        self.scale = np.r_[hypothesis.scale, [0.1] * len(self.uncertain)]
        self.prior_std = np.array(list(self.uncertain.values()))
        self.amplitude_weight = 1.0 / np.maximum(data.amplitude_std, EXACT)

    def holding(self, number: int, value: float) -> "Model":
        """The model with one of its numbers known."""
        held = copy(self)
        held.low, held.high = self.low.copy(), self.high.copy()
        held.low[number] = held.high[number] = value
        return held

    @property
    def dof(self) -> int:
        """Data less what is fitted without a prior: phases, unknown amplitudes, the hypothesis."""
        return int(self.data.dof.sum()) - int(self.tone_tests.sum()) - self.size

    @property
    def tone_tests(self) -> np.ndarray:
        """Whether (T,) a test has a tone that the hypothesis answers to; its phase is free."""
        return np.array([self.has_tone and s.has_tone for s in self.data.spectra])

    def fits_tone_phase(self, point: Point) -> bool:
        """Whether phases of a foreign vibration that acts are among what is unknown of the tests."""
        return self.has_tone and bool(np.isfinite(point.tone_phase).any())

    def uncertain_starts(self) -> np.ndarray:
        """Uncertain numbers (1 + 2 u, u) as stated, and each of them well off to either side."""
        off = OFF * np.diag(self.prior_std)
        stated = np.ones((1, self.prior_std.size))
        return np.maximum(np.concatenate([stated, stated + off, stated - off]), self.low[self.size :])

    def values(self, x: np.ndarray) -> Values:
        nuisance = {name: {"scale": float(s)} for name, s in zip(self.uncertain, x[self.size :], strict=True)}
        return {**nuisance, **self.hypothesis.values(x[: self.size])}

    def simulate(self, points: Sequence[Point]) -> tuple[np.ndarray, np.ndarray, Warm]:
        """Harmonics (n, T, C, K) of points, found or not (n, T), and where to go on from (n T rows)."""
        data = self.data
        rows = np.concatenate(
            [
                simulation.records(
                    data.model,
                    data.law,
                    self.values(point.x),
                    data.omega,
                    self.reference * np.exp(point.amplitude),
                )
                for point in points
            ]
        )
        tone_phase = np.concatenate([point.tone_phase for point in points])
        done = self._respond(rows, tone_phase, joined([point.warm for point in points]))
        shape = (len(points), data.tests)
        harmonics = done.harmonics.reshape(*shape, 2, -1)[:, :, : data.shape[0]]
        return harmonics, done.found.reshape(shape), done.warm

    def _respond(self, rows: np.ndarray, tone_phase: np.ndarray, warm: Warm) -> simulation.Responses:
        tone = self.data.tone
        if self.has_tone and tone is not None:
            times = len(rows) // self.data.tests
            timings = self.data.timings * times
            harmonics = self.data.shape[1]
            return simulation.respond_with_tone(
                rows, warm, harmonics, tone, timings, tone_phase, self.tolerance
            )
        done = simulation.respond(rows, warm, SIMULATED, self.tolerance)
        if tone is None:
            return done
        silent = np.zeros((len(rows), 2, 1))  # a periodic response has nothing there
        return done._replace(harmonics=np.concatenate([done.harmonics, silent], axis=-1))

    def evaluate_all(self, points: Sequence[Point]) -> list[Evaluation]:
        """Simulate many points at once."""
        data = self.data
        harmonics, found, after = self.simulate(points)
        harmonics = np.where(found[:, :, None, None], harmonics, 0.0)
        shown = data.compared(harmonics)
        whitened = data.whiten(shown)
        phase, aliases = self._aligned(harmonics, whitened)
        residual = real(data.whitened - data.whiten(aliases) - data.rotated(whitened, phase))
        n = data.tests
        return [
            Evaluation(
                replace(points[i], warm=after.of(slice(i * n, (i + 1) * n))),
                whitened[i],
                shown[i],
                phase[i],
                aliases[i],
                residual[i],
                self._prior(points[i]),
                found[i],
            )
            for i in range(len(points))
        ]

    def _aligned(self, harmonics: np.ndarray, whitened: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Start phases (n, T), and images (n, T, C, H) in each record unless something kept them out."""
        data = self.data
        phase = data.start_phase(whitened)
        aliases = data.aliases(harmonics, phase)
        if not aliases.any():
            return phase, aliases
        left = data.whitened - data.rotated(whitened, phase)
        both = np.stack([left - data.whiten(aliases), left])
        with_images, without = (np.abs(both) ** 2).sum((-2, -1), keepdims=True)
        aliases[np.broadcast_to(with_images > without + FILTERED, aliases.shape)] = 0.0
        phase = data.start_phase(whitened, data.whiten(aliases))
        return phase, np.where(aliases != 0.0, data.aliases(harmonics, phase), 0.0)

    def evaluate(self, point: Point) -> Evaluation:
        return self.evaluate_all([point])[0]

    def sticks(self, evaluation: Evaluation) -> np.ndarray:
        """Whether (T,) a test was measured to move and sticks in a trial: no slope leads out of there."""
        moved = (np.abs(evaluation.whitened) ** 2).sum(axis=(-2, -1))
        return evaluation.found_tests & (moved < STICKS**2 * self.data.power)

    def _prior(self, point: Point) -> np.ndarray:
        return np.r_[point.amplitude * self.amplitude_weight, (point.x[self.size :] - 1.0) / self.prior_std]

    def start(self, base: "Fit | None", x: np.ndarray) -> Point:
        """Point with the numbers of the hypothesis and everything else as a base fit has it."""
        if base is None:
            nothing = np.zeros(self.data.tests)
            ones = np.ones(len(self.uncertain))
            return Point(np.r_[x, ones], nothing, np.full(nothing.size, np.nan), at_rest(nothing.size))
        known = dict(zip(base.model.uncertain, base.x[base.model.size :], strict=True))
        rest = [known.get(name, 1.0) for name in self.uncertain]
        return replace(base.evaluation.point, x=np.r_[x, rest])
