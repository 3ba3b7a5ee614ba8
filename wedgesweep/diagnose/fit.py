"""Weighted least squares of a hypothesis and all that is unknown beside it (Levenberg and Marquardt).

Unknown are the numbers of the hypothesis, the uncertain numbers of the model with their priors, and of
each test its start phase and its input amplitude. Phases have a closed way out (``Problem.start_phase``);
amplitudes are local to a test, so that each step solves for them test by test.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.special import chdtrc

from wedgesweep.diagnose import simulation
from wedgesweep.diagnose.coordinates import Hypothesis, Values
from wedgesweep.diagnose.problem import Problem, real
from wedgesweep.diagnose.simulation import Warm

# The effect that answers to a foreign tone.
TONE = "stray_vibration"
# Finite differences: share of a coordinate's width, and of an amplitude. The noise of a simulation looks like
# information: shorter steps make intervals too narrow where amplitude and effect are hard to tell apart.
STEP, AMPLITUDE_STEP = 2e-3, 2e-3
# An exactly known amplitude, as a relative standard deviation.
EXACT = 1e-6
ITERATIONS = 40
# A fit has arrived when a step promises less than this of Q, or this share of what Q has above noise: far
# from the data the last digit is of no use.
ARRIVED, ARRIVED_SHARE = 0.02, 1e-3
# Share of its promise that a step must keep for the derivatives to be carried on by its secant.
TRUSTED = 0.1
# Damping of a step at the start, and at which it has failed.
DAMPING, STUCK = 1e-3, 1e8
# Eigenvalue of scaled normal equations below which they leave a combination of numbers open.
OPEN = 1e-12
# Largest step of one iteration, in widths of the coordinates.
LONGEST_STEP = 3.0
# Largest relative step of an input amplitude.
LONGEST_AMPLITUDE = 0.1


@dataclass(frozen=True)
class Point:
    """A guess: numbers ``x`` (k + u,) of hypothesis and uncertain model, ``amplitude`` (T,) in logarithm."""

    x: np.ndarray
    amplitude: np.ndarray
    warm: Warm


@dataclass(frozen=True)
class Trial:
    """A simulated point: whitened harmonics (T, C, H), their rotation (T,) and what is left."""

    point: Point
    whitened: np.ndarray
    harmonics: np.ndarray
    phase: np.ndarray
    residual: np.ndarray
    prior: np.ndarray
    found_tests: np.ndarray

    @property
    def found(self) -> bool:
        return bool(self.found_tests.all())

    @cached_property
    def by_test(self) -> np.ndarray:
        """Squared misfit of each test, its amplitude's prior included (T,)."""
        return (self.residual**2).sum(-1) + self.prior[: len(self.residual)] ** 2

    @cached_property
    def q(self) -> float:
        return float((self.residual**2).sum() + (self.prior**2).sum()) if self.found else np.inf


@dataclass(frozen=True)
class Fit:
    """Where a fit ended; ``covariance`` (k + u, k + u) is that of ``trial.point.x``."""

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


class Tangents(NamedTuple):
    """Derivatives of the residual by the numbers (T, m, k + u), and by phase and amplitude (T, m, 2)."""

    by_number: np.ndarray
    by_test: np.ndarray


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
        self.toned = problem.tone is not None and TONE in hypothesis.effects
        # An effect on trial is no nuisance at the same time: it is free of its prior.
        self.uncertain = {k: s for k, s in problem.uncertain.items() if k not in hypothesis.effects}
        self.low = np.r_[hypothesis.low, [0.2] * len(self.uncertain)]
        self.high = np.r_[hypothesis.high, [5.0] * len(self.uncertain)]
        self.width = np.r_[hypothesis.width, [0.1] * len(self.uncertain)]
        self.prior_std = np.array(list(self.uncertain.values()))
        self.amplitude_weight = 1.0 / np.maximum(problem.amplitude_std, EXACT)

    @property
    def dof(self) -> int:
        """Data less what is fitted without a prior: phases, unknown amplitudes, the hypothesis."""
        return int(self.problem.dof.sum()) - int(self.tones.sum()) - self.size

    @property
    def tones(self) -> np.ndarray:
        """Whether (T,) a test has a tone that the hypothesis answers to; its phase is free."""
        return np.array([self.toned and s.tone is not None for s in self.problem.spectra])

    def values(self, x: np.ndarray) -> Values:
        nuisance = {name: {"scale": float(s)} for name, s in zip(self.uncertain, x[self.size :], strict=True)}
        return {**nuisance, **self.hypothesis.values(x[: self.size])}

    def simulate(
        self, x: np.ndarray, amplitude: np.ndarray, warm: Warm
    ) -> tuple[np.ndarray, np.ndarray, Warm]:
        """Harmonics (n, T, C, H) of points ``x`` (n, k + u) and log ``amplitude`` (n, T); found or not."""
        problem = self.problem
        rows = np.concatenate(
            [
                simulation.records(
                    problem.model, problem.law, self.values(each), problem.omega, self.reference * np.exp(a)
                )
                for each, a in zip(x, amplitude, strict=True)
            ]
        )
        done = self._respond(rows, warm)
        shape = (len(x), problem.tests)
        harmonics = done.harmonics.reshape(*shape, 2, -1)[:, :, : problem.shape[0]]
        return harmonics, done.found.reshape(shape), done.warm

    def _respond(self, rows: np.ndarray, warm: Warm) -> simulation.Responses:
        harmonics, tone = self.problem.shape[1], self.problem.tone
        if self.toned and tone is not None:
            times = len(rows) // self.problem.tests
            meetings = self.problem.meetings * times
            return simulation.respond_with_tone(rows, warm, harmonics, tone, meetings, self.tolerance)
        done = simulation.respond(rows, warm, harmonics, self.tolerance)
        if tone is None:
            return done
        silent = np.zeros((len(rows), 2, 1))  # a periodic response has nothing there
        return done._replace(harmonics=np.concatenate([done.harmonics, silent], axis=-1))

    def trials(self, x: np.ndarray, amplitude: np.ndarray, warm: Warm) -> list[Trial]:
        """Simulate n points; the warm start of each is T rows of ``warm``."""
        problem = self.problem
        harmonics, found, after = self.simulate(x, amplitude, warm)
        harmonics = np.where(found[:, :, None, None], harmonics, 0.0)
        whitened = problem.whiten(harmonics)
        phase = problem.start_phase(whitened)
        residual = real(problem.whitened - problem.turned(whitened, phase))
        n = problem.tests
        return [
            Trial(
                Point(x[i], amplitude[i], after.of(slice(i * n, (i + 1) * n))),
                whitened[i],
                harmonics[i],
                phase[i],
                residual[i],
                self._prior(x[i], amplitude[i]),
                found[i],
            )
            for i in range(len(x))
        ]

    def trial(self, point: Point) -> Trial:
        return self.trials(point.x[None], point.amplitude[None], point.warm)[0]

    def _prior(self, x: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        return np.r_[amplitude * self.amplitude_weight, (x[self.size :] - 1.0) / self.prior_std]

    def tangents(self, trial: Trial, side: float = 1.0) -> Tangents:
        """Derivatives of the residual, from a simulation of each step.

        ``side``: to which side (1 or -1) numbers are changed, where the bounds allow it.
        """
        x = trial.point.x
        steps = np.r_[side * STEP * self.width, side * AMPLITUDE_STEP]
        low, high = np.append(self.low - x, -np.inf), np.append(self.high - x, np.inf)
        steps = np.where((low <= steps) & (steps <= high), steps, -steps)
        back = (low <= -steps) & (-steps <= high)
        columns, _ = derivatives(lambda moved: self._changes(trial, moved), steps, back)
        return Tangents(columns[..., :-1], np.stack([self._turn(trial), columns[..., -1]], axis=-1))

    def _turn(self, trial: Trial) -> np.ndarray:
        """Derivative of the residual by the start phase (T, m)."""
        problem = self.problem
        orders = np.r_[problem.orders, [0] * (problem.columns - problem.orders.size)]
        return real(-1j * orders * problem.turned(trial.whitened, trial.phase))

    def carried(self, tangents: Tangents, trial: Trial, reached: Trial) -> Tangents:
        """Derivatives where a step has led: the least change of them that agrees with it (Broyden, 1965).

        Test by test, in widths of the coordinates; that by the phase is known.
        """
        step = np.empty((self.problem.tests, len(self.width) + 1))
        step[:, :-1] = reached.point.x - trial.point.x
        step[:, -1] = reached.point.amplitude - trial.point.amplitude
        turn = self._turn(reached)
        turned = np.angle(np.exp(1j * (reached.phase - trial.phase)))
        columns = np.concatenate([tangents.by_number, tangents.by_test[..., 1:]], axis=-1)
        told = np.einsum("tmk,tk->tm", columns, step) + turn * turned[:, None]
        miss = reached.residual - trial.residual - told
        weighed = step / np.r_[self.width, LONGEST_AMPLITUDE] ** 2
        square = np.maximum((weighed * step).sum(axis=1, keepdims=True), np.finfo(float).tiny)
        columns = columns + miss[..., None] * (weighed / square)[:, None]
        return Tangents(columns[..., :-1], np.stack([turn, columns[..., -1]], axis=-1))

    def _changes(self, trial: Trial, steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Changes of the residual (n, T, m) by steps (n, k + u + 1), the last of amplitudes; found or not."""
        point, problem = trial.point, self.problem
        x, amplitude = point.x + steps[:, :-1], point.amplitude + steps[:, -1:]
        harmonics, found, _ = self.simulate(x, amplitude, point.warm.repeated(len(x)))
        moved = problem.turned(problem.whiten(harmonics), np.repeat(trial.phase[None], len(x), axis=0))
        return real(problem.turned(trial.whitened, trial.phase) - moved), found

    def cautious(self, trial: Trial) -> Tangents:
        """Derivatives to the side to which less changes.

        Across a jump of the response they would be large, and seem to tell a number ever so precisely.
        """
        return Tangents(*map(_smaller, self.tangents(trial), self.tangents(trial, -1.0)))

    def equations(self, trial: Trial, tangents: Tangents | None = None) -> "Equations":
        """Normal equations of a step from a trial, with its own derivatives if none are given."""
        by_number, by_test = self.tangents(trial) if tangents is None else tangents
        tests = self.problem.tests
        inner = np.einsum("tmi,tmj->tij", by_test, by_test)
        inner[:, 1, 1] += self.amplitude_weight**2
        inner += 1e-12 * (1.0 + np.einsum("tii->t", inner))[:, None, None] * np.eye(2)
        right = np.einsum("tmi,tm->ti", by_test, trial.residual)
        right[:, 1] += self.amplitude_weight * trial.prior[:tests]
        outer = np.einsum("tmk,tml->kl", by_number, by_number)
        gradient = np.einsum("tmk,tm->k", by_number, trial.residual)
        free = np.arange(self.size, len(gradient))
        outer[free, free] += self.prior_std**-2.0
        gradient[self.size :] += trial.prior[tests:] / self.prior_std
        return Equations(inner, np.einsum("tmi,tmk->tik", by_test, by_number), right, outer, gradient)

    def start(self, base: "Fit | None", x: np.ndarray) -> Point:
        """Point with the numbers of the hypothesis and everything else as a base fit has it."""
        if base is None:
            nothing = np.zeros(self.problem.tests)
            return Point(np.r_[x, np.ones(len(self.uncertain))], nothing, simulation.cold(nothing.size))
        known = dict(zip(base.model.uncertain, base.x[base.model.size :], strict=True))
        rest = [known.get(name, 1.0) for name in self.uncertain]
        return Point(np.r_[x, rest], base.trial.point.amplitude, base.trial.point.warm)


def derivatives(
    changes: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], steps: np.ndarray, back: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives (T, ..., n) of responses by n numbers, 0 where there is none, and whether (n, T) there is.

    ``changes``: what steps (j, n) change in each response (j, T, ...), and whether (j, T) it was found;
    ``steps`` (n,): of each number; ``back`` (n,): whether it may be changed to the other side.
    """
    change, found = changes(np.diag(steps))
    # Beyond the limit at which a wedge locks there is no response: the near side tells.
    lost = np.flatnonzero(~found.all(axis=1) & back)
    if lost.size:
        near, near_found = changes(np.diag(-steps)[lost])
        change[lost] = np.where(_beside(found[lost], near), change[lost], -near)
        found[lost] |= near_found
    return np.moveaxis(np.where(_beside(found, change), change, 0.0), 0, -1) / steps, found


def _beside(found: np.ndarray, values: np.ndarray) -> np.ndarray:
    """``found`` (j, T) with as many axes as ``values`` (j, T, ...)."""
    return found.reshape(*found.shape, *[1] * (values.ndim - found.ndim))


def _smaller(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Of two derivatives (T, m, k), test by test and number by number, the one of less length."""
    shorter = (one**2).sum(axis=1) <= (other**2).sum(axis=1)
    return np.where(shorter[:, None], one, other)


@dataclass(frozen=True)
class Equations:
    """Normal equations: numbers (k), and phase and amplitude of each test (T, 2), solved for first."""

    inner: np.ndarray
    mixed: np.ndarray
    right: np.ndarray
    outer: np.ndarray
    gradient: np.ndarray

    def eliminated(self, damping: float) -> tuple[np.ndarray, np.ndarray]:
        """What phases and amplitudes do by themselves (T, 2), and along with the numbers (T, 2, k)."""
        inner = self.inner.copy()
        inner[:, 1, 1] *= 1.0 + damping
        solved = np.linalg.solve(inner, np.concatenate([self.mixed, self.right[..., None]], axis=-1))
        return solved[..., -1], solved[..., :-1]

    def reduced(self, damping: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Matrix (k, k) and gradient (k,) for the numbers alone."""
        own, along = self.eliminated(damping)
        matrix = self.outer - np.einsum("tik,til->kl", self.mixed, along)
        return matrix, self.gradient - np.einsum("tik,ti->k", self.mixed, own)

    def local(self, numbers: np.ndarray, damping: float) -> np.ndarray:
        """Steps of phase and amplitude (T, 2) that go with a step of the numbers (k,)."""
        own, along = self.eliminated(damping)
        return -own - along @ numbers

    def promise(self, numbers: np.ndarray, local: np.ndarray) -> float:
        """What a step takes off Q if the responses are linear."""
        slope = self.gradient @ numbers + (self.right * local).sum()
        bend = numbers @ self.outer @ numbers + np.einsum("ti,tij,tj->", local, self.inner, local)
        bend += 2.0 * np.einsum("ti,tik,k->", local, self.mixed, numbers)
        return float(-2.0 * slope - bend)


def refine(model: Model, start: Trial, iterations: int = ITERATIONS) -> Fit:
    """Follow a trial to the nearest minimum of Q within the bounds.

    Derivatives are carried along while steps keep their promises; where it ends they are its own.
    """
    trial, damping, arrived = start, DAMPING, False
    matrix = np.zeros((len(model.low), len(model.low)))
    tangents, own = None, True
    for _ in range(iterations):
        if not trial.found:
            break
        if tangents is None:
            tangents, own = model.tangents(trial), True
        equations = model.equations(trial, tangents)
        matrix, _ = equations.reduced()
        better, promised = None, np.inf
        little = max(ARRIVED, ARRIVED_SHARE * (trial.q - model.dof))
        while better is None and damping < STUCK:
            step, promised, limited = _step(model, trial.point, equations, damping)
            # A step cut short at a limit may promise nothing; a more damped one still may.
            if promised < little and not limited:
                break
            better = _better(model, trial, step) if promised >= little else None
            if better is None and not own:
                break
            if better is None:
                damping *= 8.0
        if better is None and not own:
            tangents = None
            continue
        if better is None:
            arrived = promised < little
            break
        gained = trial.q - better.q
        kept = gained > TRUSTED * promised
        tangents, own = model.carried(tangents, trial, better) if kept else None, False
        trial, damping = better, max(damping / (8.0 if gained > 0.5 * promised else 1.0), 1e-9)
    return Fit(model, trial, _covariance(matrix), arrived)


def _better(model: Model, trial: Trial, step: Point) -> Trial | None:
    tried = model.trial(step)
    return tried if tried.q < trial.q else None


def exact(fit: Fit) -> Fit:
    """A fit followed on with responses so exact that their error cannot pass for information."""
    model = Model(fit.model.problem, fit.model.hypothesis, fit.model.reference, simulation.TIGHT)
    found = refine(model, model.trial(fit.trial.point))
    if not found.trial.found:
        return fit
    matrix, _ = model.equations(found.trial, model.cautious(found.trial)).reduced()
    return replace(found, covariance=_covariance(matrix))


def restrict(fit: Fit, rows: np.ndarray) -> Fit:
    """The same point on some of a fit's tests."""
    model = Model(fit.model.problem.subset(rows), fit.model.hypothesis, fit.model.reference[rows])
    point = fit.trial.point
    trial = model.trial(Point(point.x, point.amplitude[rows], point.warm.of(rows)))
    return Fit(model, trial, fit.covariance, fit.arrived)


def _step(model: Model, point: Point, equations: Equations, damping: float) -> tuple[Point, float, bool]:
    """The point after a damped step, what it promises to take off Q, and whether a limit cut it short."""
    x = point.x
    matrix, gradient = equations.reduced(damping)
    free = ~(((x <= model.low) & (gradient > 0.0)) | ((x >= model.high) & (gradient < 0.0)))
    step = np.zeros(len(x))
    if free.any():
        inner = matrix[np.ix_(free, free)]
        scale = np.diag(np.diag(inner) + 1e-12 * (1.0 + np.trace(inner)))
        step[free] = -np.linalg.solve(inner + damping * scale, gradient[free])
    longest = np.max(np.abs(step) / model.width, initial=0.0)
    if longest > LONGEST_STEP:
        step *= LONGEST_STEP / longest
    aim = np.clip(x + step, model.low, model.high)
    limited = bool((aim != x + step).any())
    within = aim - x
    local = equations.local(within, damping)
    limited = limited or bool((np.abs(local[:, 1]) > LONGEST_AMPLITUDE).any())
    local[:, 1] = np.clip(local[:, 1], -LONGEST_AMPLITUDE, LONGEST_AMPLITUDE)
    promised = equations.promise(within, local)
    return replace(point, x=x + within, amplitude=point.amplitude + local[:, 1]), promised, limited


def _covariance(matrix: np.ndarray) -> np.ndarray:
    """Inverse of the matrix of normal equations; what they say nothing of is wide, not exact."""
    size = np.sqrt(np.diag(matrix))
    size = np.where(size > 0.0, size, 1.0)
    values, vectors = np.linalg.eigh(matrix / np.outer(size, size))
    inverse = vectors / np.maximum(values, OPEN) @ vectors.T
    return inverse / np.outer(size, size)
