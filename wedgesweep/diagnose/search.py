"""Fits of every candidate alone; see pairs.py for two at a time."""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property
from math import log
from typing import TypeVar

import numpy as np

from wedgesweep.diagnose import detour, simulation
from wedgesweep.diagnose.amplitudes import best_amplitudes
from wedgesweep.diagnose.constancy import Constancy, constancy
from wedgesweep.diagnose.coordinates import Hypothesis
from wedgesweep.diagnose.meeting import met
from wedgesweep.diagnose.model import Fit, Model, Trial
from wedgesweep.diagnose.problem import Problem
from wedgesweep.diagnose.refine import refine
from wedgesweep.diagnose.tone import TONE
from wedgesweep.solvers.periodic import at_rest

# What one more number costs is ln n + PENALTY: with 21 candidates clean data keep the base model.
PENALTY = 6.0
# Starting points that are followed, and for how many iterations; the best of the last go on to the end.
FOLLOWED = ((4, 3), (2, 4))
# Times the base model's misfit at which an effect that was followed a little way goes no further alone.
HOPELESS = 100.0
# How the starts are followed once more, all of them at first, where nothing will do.
AGAIN = ((None, 3), (4, 5), (2, 8))
# Best explanations of which those that leave more than noise look for a way around what holds them up.
DETOURS = 8
# Least probability of what is left at which a model is possible at all.
POSSIBLE = 1e-3
# Relative error of a stated input amplitude that is no measurement's, but the base model's.
ASTRAY = 0.3
# Then fits begin with iterations in which it is no further off than this.
AS_STATED, HELD = 8, 1e-4
# A fit is better if it takes this much off Q.
SLIGHT = 1.0
# Effects with states of their own take longest.
LONGEST = ("column_compliance", "fixture_resonance", "presliding")
TONE_FREQUENCY = f"{TONE}.frequency_hz"


def unknown_reference(problem: Problem) -> np.ndarray:
    """Input amplitudes (T,) in m about which a fit looks: the stated ones, else the fundamental's."""
    fundamental = np.abs(problem.measured[:, 0, 0])
    return np.where(np.isinf(problem.amplitude_std), fundamental, problem.amplitude)


@dataclass(frozen=True)
class Explanation:
    """A hypothesis with its fit, and what a number costs."""

    fit: Fit
    price: float

    @property
    def effects(self) -> tuple[str, ...]:
        return self.fit.effects

    @cached_property
    def constancy(self) -> Constancy:
        """Whether its numbers are the same in all tests."""
        return constancy(self.fit)

    @property
    def adequacy(self) -> float:
        """Probability of what it leaves, or of numbers that are constant, if that is less.

        The latter takes simulations: it is not looked at where the former is out of the question.
        """
        return min(self.fit.p, self.constancy.p) if self.fit.p >= POSSIBLE else self.fit.p

    @property
    def penalised(self) -> float:
        return self.fit.q + self.price * self.fit.model.size


def penalised(each: Explanation) -> float:
    """What explanations are ranked by."""
    return each.penalised


Each = TypeVar("Each", Fit, Explanation)


class Search:
    """All fits to one problem; ``progress`` is told each step that is done."""

    def __init__(
        self,
        problem: Problem,
        effects: Sequence[str],
        threads: int = 1,
        progress: Callable[[str], None] = lambda step: None,
    ) -> None:
        self.problem, self.threads, self.progress = problem, threads, progress
        # Where no tone stands out there is nothing to fit one to.
        self.unheard = TONE in effects and problem.tone is None
        self.effects = tuple(name for name in effects if name != TONE or not self.unheard)
        self.reference = unknown_reference(problem)
        self.price = log(problem.points.sum()) + PENALTY
        # What was simulated of each effect over its range beside the base model.
        self.along: dict[str, Sequence[Trial]] = {}

    def model(self, *effects: str, tolerance: float = simulation.TOLERANCE) -> Model:
        tone = self.problem.tone
        fixed = ((TONE_FREQUENCY, tone),) if tone is not None and TONE in effects else ()
        return Model(self.problem, Hypothesis(effects, fixed), self.reference, tolerance)

    def explanation(self, fit: Fit) -> Explanation:
        return Explanation(fit, self.price)

    def base(self) -> Explanation:
        """The model on trial with everything fitted that is unknown about the tests."""
        model = self.model()
        start = model.start(None, np.zeros(0))
        trials = best_amplitudes(model, [replace(start, x=x) for x in model.uncertain_starts()])
        fits = self.each(lambda trial: refine(model, trial), trials)
        if model.uncertain and min(fits, key=lambda fit: fit.q).p < POSSIBLE:
            # Inputs may have made up for numbers that they should have led to.
            fits += self.each(lambda trial: refine(model, _as_stated(model, trial)), trials)
        fit = self._meeting(detour.around(min(fits, key=lambda fit: fit.q)))
        return self.explanation(fit)

    def base_again(self, base: Explanation, found: Sequence[Explanation]) -> Explanation:
        """The base model, or a better fit of it from where the best of its extensions ended.

        What it has lost by stopping short is no gain of theirs.
        """
        best = min(found, key=penalised, default=base).fit
        model, numbers = self.model(), best.model.values(best.x)
        x = np.array([numbers[name]["scale"] for name in model.uncertain])
        start = replace(best.trial.point, x=x, warm=at_rest(self.problem.tests))
        fit = refine(model, model.trial(start))
        return self.explanation(self._meeting(fit)) if fit.q < base.fit.q - SLIGHT else base

    def _meeting(self, fit: Fit) -> Fit:
        """The fit, followed on where its start phases tell how input and foreign tone met in each record."""
        self.problem = replace(self.problem, start=fit.trial.phase)
        if not fit.model.toned:
            return fit
        model = self.model(*fit.effects)
        return met(refine(model, model.trial(fit.trial.point)))

    def single(self, effect: str, base: Fit) -> Explanation:
        """Best fit of one effect; the trials among which it began are kept in ``along``."""
        model, rough = self.model(effect), self.model(effect, tolerance=simulation.ROUGH)
        points = model.hypothesis.starts()
        trials = best_amplitudes(rough, [model.start(base, x) for x in points])
        self.along[effect] = trials
        trials = _best_along_first(trials)
        if effect == TONE or _astray(base):
            # What the base model made of the effect has led its own numbers far astray, or may have.
            fresh = best_amplitudes(rough, [model.start(None, x) for x in points])
            trials = trials + fresh
            if _astray(base):
                trials = trials + [_as_stated(model, trial) for trial in _leading(fresh, FOLLOWED[0][0])]
        # Where the base model will do, a cause could only be weak: one start is as good as another.
        followed = FOLLOWED if base.p < POSSIBLE else ((1, 3),)
        fit = best_of(model, trials, followed, HOPELESS * base.q)
        if effect == TONE:
            fit = self._meeting(fit)
        self.progress(effect)
        return self.explanation(fit)

    def singles(self, base: Fit) -> list[Explanation]:
        """Best fits of every effect, in their order."""
        return self._each_effect(lambda effect: self.single(effect, base))

    def around(self, found: Sequence[Explanation]) -> list[Explanation]:
        """Explanations, the best first; the best ones of them around what held up their fits."""
        best = sorted(found, key=penalised)[:DETOURS]
        best = [each for each in best if each.fit.p < POSSIBLE]
        again = self.each(lambda each: self.explanation(detour.around(met(each.fit))), best)
        return best_of_each([*again, *found], penalised)

    def everywhere(self) -> list[Explanation]:
        """Singles again, from every value of their first number at which they were tried.

        Next to breakaway a single test can make the start of the right way look worse than all others.
        """
        return self._each_effect(self._from_everywhere)

    def _from_everywhere(self, effect: str) -> Explanation:
        trials = _best_along_first(self.along[effect])
        self.progress(f"{effect}, from everywhere")
        return self.explanation(best_of(self.model(effect), trials, AGAIN))

    def _each_effect(self, function: Callable[[str], Explanation]) -> list[Explanation]:
        """What a function finds for every effect, in their order; the longest begin first."""
        order = sorted(self.effects, key=lambda effect: effect not in LONGEST)
        found = dict(zip(order, self.each(function, order), strict=True))
        return [found[effect] for effect in self.effects]

    def each(self, function: Callable, items: Iterable) -> list:
        if self.threads == 1:
            return [function(item) for item in items]
        with ThreadPoolExecutor(self.threads) as pool:
            return list(pool.map(function, items))


def best_of_each(found: Iterable[Each], misfit: Callable[[Each], float]) -> list[Each]:
    """Of fits or explanations, the best one of each set of effects; sorted, the best first."""
    best: dict[frozenset[str], Each] = {}
    for each in sorted(found, key=misfit):
        best.setdefault(frozenset(each.effects), each)
    return list(best.values())


def _astray(base: Fit) -> bool:
    """Whether a base model makes up for what it lacks by inputs that are far from those stated."""
    stated = np.isfinite(base.model.problem.amplitude_std)
    return bool((np.abs(base.trial.point.amplitude[stated]) > ASTRAY).any())


def _as_stated(model: Model, trial: Trial) -> Trial:
    """Where a trial leads while the input amplitudes stay those stated."""
    std = model.problem.amplitude_std
    held = replace(model.problem, amplitude_std=np.where(np.isinf(std), std, np.minimum(std, HELD)))
    strict = Model(held, model.hypothesis, model.reference, model.tolerance)
    found = refine(strict, strict.trial(trial.point), AS_STATED)
    return model.trial(found.trial.point)


def _leading(trials: Sequence[Trial], entering: int | None) -> list[Trial]:
    return sorted(trials, key=lambda each: each.q)[:entering]


def _best_along_first(trials: Sequence[Trial]) -> list[Trial]:
    """The best trial at each value of the first number, so that not all that are followed are neighbours."""
    best: dict[float, Trial] = {}
    for trial in sorted(trials, key=lambda each: each.q):
        best.setdefault(float(trial.point.x[0]), trial)
    return list(best.values())


def best_of(
    model: Model,
    trials: Sequence[Trial],
    followed: Sequence[tuple[int | None, int]] = FOLLOWED,
    limit: float = np.inf,
) -> Fit:
    """Follow the best few trials a little way, the best of these further, the best of those to the end.

    ``limit``: misfit that the first few iterations must get below. The trials may be a rougher model's.
    """
    trials = model.trials([trial.point for trial in _leading(trials, followed[0][0])])
    for entering, iterations in followed:
        fits = [refine(model, trial, iterations) for trial in _leading(trials, entering)]
        trials = [fit.trial for fit in fits]
        best = min(fits, key=lambda fit: fit.q)
        if best.q > limit:
            return best
    return best if best.arrived else refine(model, best.trial)
