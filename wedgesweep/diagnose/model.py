"""A hypothesis on the tests of a problem: what it simulates at a point, and how far that is from the data.

Unknown are the numbers of the hypothesis, the uncertain numbers of the model with their priors, and of
each test its start phase and its input amplitude. Phases have a closed way out (``Problem.start_phase``).
"""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.special import chdtrc

from wedgesweep.diagnose import simulation
from wedgesweep.diagnose.coordinates import Hypothesis, Values
from wedgesweep.diagnose.problem import Problem, real
from wedgesweep.diagnose.spectra import FOLDED
from wedgesweep.diagnose.tone import TONE
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

    ``ahead`` (T,): phase (rad) of the vibration behind a foreign tone, NaN where it is not known: see
    meeting.py.
    """

    x: np.ndarray
    amplitude: np.ndarray
    ahead: np.ndarray
    warm: Warm

    def moved(self, numbers: np.ndarray, local: np.ndarray) -> "Point":
        """After steps of the numbers (k,) and of what is local to tests (T, L): amplitude, ``ahead``."""
        ahead = self.ahead + local[..., 1] if local.shape[-1] > 1 else self.ahead
        return replace(self, x=self.x + numbers, amplitude=self.amplitude + local[..., 0], ahead=ahead)


@dataclass(frozen=True)
class Trial:
    """A simulated point: whitened harmonics (T, C, H), their rotation (T,) and what is left.

    ``images`` (T, C, H) are those of harmonics above half the sampling rate, 0 in a record that looks as if
    it had been low-passed before it was sampled.
    """

    point: Point
    whitened: np.ndarray
    harmonics: np.ndarray
    phase: np.ndarray
    images: np.ndarray
    residual: np.ndarray
    prior: np.ndarray
    found_tests: np.ndarray

    @property
    def found(self) -> bool:
        return bool(self.found_tests.all())

    @property
    def unfiltered(self) -> np.ndarray:
        """Whether (T, 1, 1) images are part of what is compared."""
        return (self.images != 0.0).any(axis=(-2, -1), keepdims=True)

    @cached_property
    def by_test(self) -> np.ndarray:
        """Squared misfit of each test, its amplitude's prior included (T,)."""
        return (self.residual**2).sum(-1) + self.prior[: len(self.residual)] ** 2

    @cached_property
    def q(self) -> float:
        return float((self.residual**2).sum() + (self.prior**2).sum()) if self.found else np.inf


def least(trials: Sequence[Trial]) -> np.ndarray:
    """Which of some trials leaves least of each test, (T,)."""
    misfit = [np.where(each.found_tests, each.by_test, np.inf) for each in trials]
    return np.argmin(misfit, axis=0)


@dataclass(frozen=True)
class Fit:
    """Where a fit ended; ``covariance`` (k + u, k + u) is that of ``trial.point.x``: see profile.py, too."""

    model: "Model"
    trial: Trial
    covariance: np.ndarray
    arrived: bool

    @property
    def effects(self) -> tuple[str, ...]:
        return self.model.hypothesis.effects

    @property
    def q(self) -> float:
        return self.trial.q

    @property
    def dof(self) -> int:
        return self.model.dof

    @property
    def excess(self) -> float:
        return self.q - self.dof

    @property
    def x(self) -> np.ndarray:
        return self.trial.point.x

    @property
    def p(self) -> float:
        """Probability of a misfit this large if the model is right."""
        return float(chdtrc(self.dof, self.q))

    @property
    def values(self) -> Values:
        """Numbers of the hypothesis in key units."""
        return self.model.hypothesis.in_key_units(self.x[: self.model.size])

    def amplitudes(self) -> np.ndarray:
        """Input amplitudes (T,) in m."""
        return self.model.reference * np.exp(self.trial.point.amplitude)


class Model:
    """A hypothesis on the tests of a problem: simulates to a tolerance, and knows what is free."""

    def __init__(
        self,
        problem: Problem,
        hypothesis: Hypothesis,
        reference: np.ndarray,
        tolerance: float = simulation.TOLERANCE,
    ) -> None:
        self.problem, self.hypothesis, self.reference = problem, hypothesis, reference
        self.tolerance = tolerance
        self.size = len(hypothesis.coordinates)
        self.toned = problem.tone is not None and TONE in {
            *acting(problem.model.effects),
            *hypothesis.effects,
        }
        # An effect on trial is no nuisance at the same time: it is free of its prior.
        self.uncertain = {k: s for k, s in problem.uncertain.items() if k not in hypothesis.effects}
        self.low = np.r_[hypothesis.low, [0.2] * len(self.uncertain)]
        self.high = np.r_[hypothesis.high, [5.0] * len(self.uncertain)]
        self.width = np.r_[hypothesis.width, [0.1] * len(self.uncertain)]
        self.prior_std = np.array(list(self.uncertain.values()))
        self.amplitude_weight = 1.0 / np.maximum(problem.amplitude_std, EXACT)

    def holding(self, number: int, value: float) -> "Model":
        """The model with one of its numbers known."""
        held = copy(self)
        held.low, held.high = self.low.copy(), self.high.copy()
        held.low[number] = held.high[number] = value
        return held

    @property
    def dof(self) -> int:
        """Data less what is fitted without a prior: phases, unknown amplitudes, the hypothesis."""
        return int(self.problem.dof.sum()) - int(self.tones.sum()) - self.size

    @property
    def tones(self) -> np.ndarray:
        """Whether (T,) a test has a tone that the hypothesis answers to; its phase is free."""
        return np.array([self.toned and s.toned for s in self.problem.spectra])

    def meets(self, point: Point) -> bool:
        """Whether phases of a foreign vibration that acts are among what is unknown of the tests."""
        return self.toned and bool(np.isfinite(point.ahead).any())

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
        problem = self.problem
        rows = np.concatenate(
            [
                simulation.records(
                    problem.model,
                    problem.law,
                    self.values(point.x),
                    problem.omega,
                    self.reference * np.exp(point.amplitude),
                )
                for point in points
            ]
        )
        ahead = np.concatenate([point.ahead for point in points])
        done = self._respond(rows, ahead, joined([point.warm for point in points]))
        shape = (len(points), problem.tests)
        harmonics = done.harmonics.reshape(*shape, 2, -1)[:, :, : problem.shape[0]]
        return harmonics, done.found.reshape(shape), done.warm

    def _respond(self, rows: np.ndarray, ahead: np.ndarray, warm: Warm) -> simulation.Responses:
        tone = self.problem.tone
        if self.toned and tone is not None:
            times = len(rows) // self.problem.tests
            meetings = self.problem.meetings * times
            harmonics = self.problem.shape[1]
            return simulation.respond_with_tone(rows, warm, harmonics, tone, meetings, ahead, self.tolerance)
        done = simulation.respond(rows, warm, FOLDED, self.tolerance)
        if tone is None:
            return done
        silent = np.zeros((len(rows), 2, 1))  # a periodic response has nothing there
        return done._replace(harmonics=np.concatenate([done.harmonics, silent], axis=-1))

    def trials(self, points: Sequence[Point]) -> list[Trial]:
        """Simulate many points at once."""
        problem = self.problem
        harmonics, found, after = self.simulate(points)
        harmonics = np.where(found[:, :, None, None], harmonics, 0.0)
        shown = problem.shown(harmonics)
        whitened = problem.whiten(shown)
        phase, images = self._aligned(harmonics, whitened)
        residual = real(problem.whitened - problem.whiten(images) - problem.turned(whitened, phase))
        n = problem.tests
        return [
            Trial(
                replace(points[i], warm=after.of(slice(i * n, (i + 1) * n))),
                whitened[i],
                shown[i],
                phase[i],
                images[i],
                residual[i],
                self._prior(points[i]),
                found[i],
            )
            for i in range(len(points))
        ]

    def _aligned(self, harmonics: np.ndarray, whitened: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Start phases (n, T), and images (n, T, C, H) in each record unless something kept them out."""
        problem = self.problem
        phase = problem.start_phase(whitened)
        images = problem.images(harmonics, phase)
        if not images.any():
            return phase, images
        left = problem.whitened - problem.turned(whitened, phase)
        both = np.stack([left - problem.whiten(images), left])
        with_images, without = (np.abs(both) ** 2).sum((-2, -1), keepdims=True)
        images[np.broadcast_to(with_images > without + FILTERED, images.shape)] = 0.0
        phase = problem.start_phase(whitened, problem.whiten(images))
        return phase, np.where(images != 0.0, problem.images(harmonics, phase), 0.0)

    def trial(self, point: Point) -> Trial:
        return self.trials([point])[0]

    def sticks(self, trial: Trial) -> np.ndarray:
        """Whether (T,) a test was measured to move and sticks in a trial: no slope leads out of there."""
        moved = (np.abs(trial.whitened) ** 2).sum(axis=(-2, -1))
        return trial.found_tests & (moved < STICKS**2 * self.problem.power)

    def _prior(self, point: Point) -> np.ndarray:
        return np.r_[point.amplitude * self.amplitude_weight, (point.x[self.size :] - 1.0) / self.prior_std]

    def start(self, base: "Fit | None", x: np.ndarray) -> Point:
        """Point with the numbers of the hypothesis and everything else as a base fit has it."""
        if base is None:
            nothing = np.zeros(self.problem.tests)
            ones = np.ones(len(self.uncertain))
            return Point(np.r_[x, ones], nothing, np.full(nothing.size, np.nan), at_rest(nothing.size))
        known = dict(zip(base.model.uncertain, base.x[base.model.size :], strict=True))
        rest = [known.get(name, 1.0) for name in self.uncertain]
        return replace(base.trial.point, x=np.r_[x, rest])
