"""Fits of every candidate alone; see pairs.py for two at a time."""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property
from math import log
from typing import TypeVar

import numpy as np

from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.least_squares import refine
from wedgesweep.diagnose.parameter_constancy import Constancy, parameter_constancy
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.amplitude_grid import best_amplitudes
from wedgesweep.diagnose.steady.fit_data import FitData
from wedgesweep.diagnose.steady.model import Evaluation, Fit, Model
from wedgesweep.diagnose.steady.tone import TONE
from wedgesweep.diagnose.steady.tone_phase import with_tone_phase
from wedgesweep.diagnose.trimmed_refit import refit_without_influential_tests
from wedgesweep.solvers.periodic import at_rest

# What one more number costs is ln n + PENALTY: with 21 candidates clean data keep the base model.
PENALTY = 6.0
# Starting points that are followed, and for how many iterations; the best of the last go on to the end.
SCHEDULE = ((4, 3), (2, 4))
# Times the base model's misfit at which an effect that was followed a little way goes no further alone.
CUT_OFF = 100.0
# How the starts are followed once more, all of them at first, where nothing will do.
MULTISTART_SCHEDULE = ((None, 3), (4, 5), (2, 8))
# Best explanations of which those that leave more than noise look for a way around what holds them up.
DETOURS = 8
# Least probability of what is left at which a model is possible at all.
POSSIBLE = 1e-3
# Relative error of a stated input amplitude that is no measurement's, but the base model's.
IMPLAUSIBLE_INPUT = 0.3
# Then fits begin with iterations in which it is no further off than this.
AS_STATED, HELD = 8, 1e-4
# A fit is better if it takes this much off Q.
SLIGHT = 1.0
# Effects with states of their own take longest.
SLOWEST = ("column_compliance", "fixture_resonance", "presliding")
TONE_FREQUENCY = f"{TONE}.frequency_hz"


def unknown_reference(data: FitData) -> np.ndarray:
    """Input amplitudes (T,) in m about which a fit looks: the stated ones, else the fundamental's."""
    fundamental = np.abs(data.measured[:, 0, 0])
    return np.where(np.isinf(data.amplitude_std), fundamental, data.amplitude)


@dataclass(frozen=True)
class Explanation:
    """A hypothesis with its fit, and what a number costs."""

    fit: Fit
    parameter_penalty: float

    @property
    def effects(self) -> tuple[str, ...]:
        return self.fit.effects

    @cached_property
    def constancy(self) -> Constancy:
        """Whether its numbers are the same in all tests."""
        return parameter_constancy(self.fit)

    @property
    def p_value(self) -> float:
        """Probability of what it leaves, or of numbers that are constant, if that is less.

        The latter takes simulations: it is not looked at where the former is out of the question.
        """
        return min(self.fit.p, self.constancy.p) if self.fit.p >= POSSIBLE else self.fit.p

    @property
    def penalised(self) -> float:
        return self.fit.chi2 + self.parameter_penalty * self.fit.model.size


def penalised(each: Explanation) -> float:
    """What explanations are ranked by."""
    return each.penalised


Each = TypeVar("Each", Fit, Explanation)


class Search:
    """All fits to one problem; ``progress`` is told each step that is done."""

    def __init__(
        self,
        data: FitData,
        effects: Sequence[str],
        threads: int = 1,
        progress: Callable[[str], None] = lambda step: None,
    ) -> None:
        self.data, self.threads, self.progress = data, threads, progress
        # Where no tone stands out there is nothing to fit one to.
        self.tone_undetected = TONE in effects and data.tone is None
        self.effects = tuple(name for name in effects if name != TONE or not self.tone_undetected)
        self.reference = unknown_reference(data)
        self.parameter_penalty = log(data.observations.sum()) + PENALTY
        # What was simulated of each effect over its range beside the base model.
        self.scans: dict[str, Sequence[Evaluation]] = {}

    def model(self, *effects: str, tolerance: float = simulation.TOLERANCE) -> Model:
        tone = self.data.tone
        fixed = ((TONE_FREQUENCY, tone),) if tone is not None and TONE in effects else ()
        return Model(self.data, Hypothesis(effects, fixed), self.reference, tolerance)

    def explanation(self, fit: Fit) -> Explanation:
        return Explanation(fit, self.parameter_penalty)

    def base(self) -> Explanation:
        """The base model with everything fitted that is unknown about the tests."""
        model = self.model()
        start = model.start(None, np.zeros(0))
        evaluations = best_amplitudes(model, [replace(start, x=x) for x in model.uncertain_starts()])
        fits = self.each(lambda evaluation: refine(model, evaluation), evaluations)
        if model.uncertain and min(fits, key=lambda fit: fit.chi2).p < POSSIBLE:
            # Inputs may have made up for numbers that they should have led to.
            fits += self.each(lambda evaluation: refine(model, _as_stated(model, evaluation)), evaluations)
        fit = self._with_tone_phase(refit_without_influential_tests(min(fits, key=lambda fit: fit.chi2)))
        return self.explanation(fit)

    def refit_base(self, base: Explanation, found: Sequence[Explanation]) -> Explanation:
        """The base model, or a better fit of it from where the best of its extensions ended.

        What it has lost by stopping short is no gain of theirs.
        """
        best = min(found, key=penalised, default=base).fit
        model, numbers = self.model(), best.model.values(best.x)
        x = np.array([numbers[name]["scale"] for name in model.uncertain])
        start = replace(best.evaluation.point, x=x, warm=at_rest(self.data.tests))
        fit = refine(model, model.evaluate(start))
        return self.explanation(self._with_tone_phase(fit)) if fit.chi2 < base.fit.chi2 - SLIGHT else base

    def _with_tone_phase(self, fit: Fit) -> Fit:
        """The fit, followed on where its start phases tell how input and foreign tone met in each record."""
        self.data = replace(self.data, start=fit.evaluation.phase)
        if not fit.model.has_tone:
            return fit
        model = self.model(*fit.effects)
        return with_tone_phase(refine(model, model.evaluate(fit.evaluation.point)))

    def single(self, effect: str, base: Fit) -> Explanation:
        """Best fit of one effect; the trials among which it began are kept in ``along``."""
        model, rough = self.model(effect), self.model(effect, tolerance=simulation.ROUGH)
        points = model.hypothesis.starts()
        evaluations = best_amplitudes(rough, [model.start(base, x) for x in points])
        self.scans[effect] = evaluations
        evaluations = _best_along_first(evaluations)
        if effect == TONE or _implausible_inputs(base):
            # What the base model made of the effect has led its own numbers far astray, or may have.
            fresh = best_amplitudes(rough, [model.start(None, x) for x in points])
            evaluations = evaluations + fresh
            if _implausible_inputs(base):
                evaluations = evaluations + [
                    _as_stated(model, evaluation) for evaluation in _leading(fresh, SCHEDULE[0][0])
                ]
        # Where the base model will do, a cause could only be weak: one start is as good as another.
        schedule = SCHEDULE if base.p < POSSIBLE else ((1, 3),)
        fit = best_of(model, evaluations, schedule, CUT_OFF * base.chi2)
        if effect == TONE:
            fit = self._with_tone_phase(fit)
        self.progress(effect)
        return self.explanation(fit)

    def singles(self, base: Fit) -> list[Explanation]:
        """Best fits of every effect, in their order."""
        return self._each_effect(lambda effect: self.single(effect, base))

    def around(self, found: Sequence[Explanation]) -> list[Explanation]:
        """Explanations, the best first; the best ones of them around what held up their fits."""
        best = sorted(found, key=penalised)[:DETOURS]
        best = [each for each in best if each.fit.p < POSSIBLE]
        again = self.each(
            lambda each: self.explanation(refit_without_influential_tests(with_tone_phase(each.fit))),
            best,
        )
        return best_of_each([*again, *found], penalised)

    def multistart(self) -> list[Explanation]:
        """Singles again, from every value of their first number at which they were tried.

        Next to breakaway a single test can make the start of the right way look worse than all others.
        """
        return self._each_effect(self._multistart_one)

    def _multistart_one(self, effect: str) -> Explanation:
        evaluations = _best_along_first(self.scans[effect])
        self.progress(f"{effect}, from multistart")
        return self.explanation(best_of(self.model(effect), evaluations, MULTISTART_SCHEDULE))

    def _each_effect(self, function: Callable[[str], Explanation]) -> list[Explanation]:
        """What a function finds for every effect, in their order; the longest begin first."""
        order = sorted(self.effects, key=lambda effect: effect not in SLOWEST)
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


def _implausible_inputs(base: Fit) -> bool:
    """Whether a base model makes up for what it lacks by inputs that are far from those stated."""
    stated = np.isfinite(base.model.data.amplitude_std)
    return bool((np.abs(base.evaluation.point.amplitude[stated]) > IMPLAUSIBLE_INPUT).any())


def _as_stated(model: Model, evaluation: Evaluation) -> Evaluation:
    """Where a trial leads while the input amplitudes stay those stated."""
    std = model.data.amplitude_std
    held = replace(model.data, amplitude_std=np.where(np.isinf(std), std, np.minimum(std, HELD)))
    strict = Model(held, model.hypothesis, model.reference, model.tolerance)
    found = refine(strict, strict.evaluate(evaluation.point), AS_STATED)
    return model.evaluate(found.evaluation.point)


def _leading(evaluations: Sequence[Evaluation], entering: int | None) -> list[Evaluation]:
    return sorted(evaluations, key=lambda each: each.chi2)[:entering]


def _best_along_first(evaluations: Sequence[Evaluation]) -> list[Evaluation]:
    """The best trial at each value of the first number, so that not all that are followed are neighbours."""
    best: dict[float, Evaluation] = {}
    for evaluation in sorted(evaluations, key=lambda each: each.chi2):
        best.setdefault(float(evaluation.point.x[0]), evaluation)
    return list(best.values())


def best_of(
    model: Model,
    evaluations: Sequence[Evaluation],
    schedule: Sequence[tuple[int | None, int]] = SCHEDULE,
    limit: float = np.inf,
) -> Fit:
    """Follow the best few trials a little way, the best of these further, the best of those to the end.

    ``limit``: misfit that the first few iterations must get below. The trials may be a rougher model's.
    """
    evaluations = model.evaluate_all(
        [evaluation.point for evaluation in _leading(evaluations, schedule[0][0])]
    )
    for entering, iterations in schedule:
        fits = [refine(model, evaluation, iterations) for evaluation in _leading(evaluations, entering)]
        evaluations = [fit.evaluation for fit in fits]
        best = min(fits, key=lambda fit: fit.chi2)
        if best.chi2 > limit:
            return best
    return best if best.converged else refine(model, best.evaluation)
