"""Fits of the base model and of every candidate effect by itself; pairs.py fits two at a time.

Each stage is a function of what earlier stages returned; nothing is kept in between.
"""

import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import count
from math import inf
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np

from wedgesweep.ablation import left_out
from wedgesweep.diagnose import work
from wedgesweep.diagnose.evaluation import Evaluation
from wedgesweep.diagnose.explanation import POSSIBLE, best_of_each, penalised
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.least_squares import BRIEF, grown, minimise, of_beginnings
from wedgesweep.diagnose.model import ROUGH, TOLERANCE, Fit, Model
from wedgesweep.diagnose.work import SLIGHT, Best, Change, HasBest, Step


class Round(NamedTuple):
    """A round of successive halving: number of best fits that enter (None: all), and iterations of each."""

    entering: int | None
    iterations: int


# Rounds from the starting points of an effect; the best fit of the last round is continued to its minimum.
SCHEDULE = (Round(4, 3), Round(2, 4))
# The same where the base model is not impossible: a cause can only be weak then, and any start will do.
SHORT_SCHEDULE = (Round(1, 3),)
# Rounds from the starting points of the base model.
BASE_SCHEDULE = (Round(None, 4), Round(3, 6))
# Number of best single effects, of best pairs and of best explanations that are looked at again.
LEADING = 8
# Work (see work.py) that a search may spend for each test, the least number of tests that it counts, and the
# share that pairs get even if unknown amplitudes made single effects expensive.
WORK_PER_TEST, FEWEST_COUNTED, PAIRS_SHARE = 1e5, 12, 1.0 / 3.0

# Evaluations of each effect over the range of its parameters, beside the base model.
Scans = Mapping[str, Sequence[Evaluation]]
Known = TypeVar("Known", bound=HasBest)


class HasEffects(Protocol):
    """Effects that may be fitted together, with what a fit of them begins with."""

    @property
    def effects(self) -> tuple[str, ...]: ...


def quiet(step: str) -> None:
    """Report no progress."""


@dataclass(frozen=True)
class Search:
    """What all stages of a search share.

    ``effects``: candidates; ``undetected``: those of which the records show nothing, so that there is nothing
    to fit. ``progress`` is called with each step. ``budget``: what may be simulated; base model and single
    effects are fitted whatever that takes. ``wider``: effects whose best numbers lie outside of the range
    that is searched, see beyond_range.py. ``finished``: fits of the present stage that are done, for the case
    that it does not end; ``failed``: effects whose own fits raised an error, with the error. ``without``:
    names of stages that are left out.
    """

    data: FitData
    effects: tuple[str, ...]
    undetected: tuple[str, ...] = ()
    threads: int = 1
    progress: Callable[[str], None] = quiet
    budget: work.Budget = field(default_factory=work.Budget, compare=False)
    wider: tuple[str, ...] = ()
    finished: list[Fit] = field(default_factory=list, compare=False)
    failed: dict[str, Exception] = field(default_factory=dict, compare=False)
    without: frozenset[str] = field(default_factory=left_out.get)

    @classmethod
    def of(
        cls,
        data: FitData,
        effects: Sequence[str],
        threads: int = 1,
        progress: Callable[[str], None] = quiet,
    ) -> "Search":
        """A search for some effects in some data."""
        detected = data.candidates(effects)
        undetected = tuple(effect for effect in effects if effect not in detected)
        budget = work.Budget(WORK_PER_TEST * max(len(data.tests_of_records), FEWEST_COUNTED))
        return cls(data, detected, undetected, threads, progress, budget)

    def tried(self, name: str, known: Known, change: Callable[[Known], Known]) -> Known:
        """What a stage makes of what is known, unless it is left out; what it changed is told."""
        if name in self.without:
            return known
        begun, before = work.done(), known.best
        known = change(known)
        work.told(Change(name, before, known.best, work.done() - begun))
        return known

    def model(self, *effects: str, tolerance: float = TOLERANCE) -> Model:
        """The model with some effects; no effects: the base model."""
        known = self.data.known
        fixed = tuple((name, value) for name, (value, _) in known.items() if name.split(".")[0] in effects)
        wider = tuple(name for name in effects if name in self.wider)
        return Model(self.data, Hypothesis(effects, fixed, self.data.units, wider), tolerance)

    def each(self, function: Callable[[Any], Any], items: Iterable[Any], what: str = "") -> list[Any]:
        """Results of a function for all items, in their order; ``what``: stage whose progress is reported."""
        return self._each(function, list(items), what)

    def each_affordable(
        self, function: Callable[[Any], Any], items: Sequence[HasEffects], what: str
    ) -> list[Any]:
        """Results for the items, the most promising first, until budget or time are over.

        ``what``: name of the stage, under which items that were left out are reported.
        """
        found = self._each(function, items, what, self.budget.left)
        self.budget.ended(what, len(found), [item.effects for item in items])
        return found

    def _each(
        self, function: Callable[[Any], Any], items: Sequence[Any], what: str = "", limit: float | None = None
    ) -> list[Any]:
        """Results for the first items, up to the one at which their work, or the time, reaches a limit.

        Threads may finish further items; their results are dropped, or they would depend on timing.
        ``what``: name of the stage whose progress is reported; "" reports nothing. Without ``limit`` only the
        end of the whole diagnosis stops it.
        """
        spent, finished = np.zeros(len(items)), count(1)
        used, ended = work.time_used(), threading.Event()

        def affordable(place: int) -> bool:
            return limit is None or (spent[:place].sum() < limit and used() < work.SEARCH_SHARE)

        def one(place: int) -> work.Uncounted | None:
            outcome = None
            if affordable(place):
                with work.limited(lambda: inf if ended.is_set() else used()):
                    outcome = work.uncounted(lambda: function(items[place]))
                spent[place] = outcome.work
            if what:
                self.progress(Step(what, next(finished), len(items)))
            return outcome

        if what:
            self.progress(Step(what, 0, len(items)))
        if self.threads == 1:
            outcomes = [one(place) for place in range(len(items))]
        else:
            with ThreadPoolExecutor(self.threads) as pool:
                try:
                    outcomes = list(pool.map(one, range(len(items))))
                except BaseException:
                    ended.set()  # the other threads stop at their next simulation
                    raise
        before = np.cumsum(np.r_[0.0, spent])[:-1]
        beyond = inf if limit is None else limit
        kept = [each for each, earlier in zip(outcomes, before, strict=True) if each and earlier < beyond]
        work.count(kept)
        return [each.result for each in kept]


class Explained(NamedTuple):
    """What a search knows: the base model, explanations, best first, and the scans of single effects."""

    search: Search
    base: Fit
    explanations: list[Fit]
    scans: Scans

    @property
    def best(self) -> Best:
        """The best explanation, or the base model."""
        best = min([self.base, *self.explanations], key=penalised)
        return Best(best.effects, best.penalised)

    def joined(self, more: Iterable[Fit]) -> "Explained":
        """The same with more explanations; of each set of effects the best one stays."""
        return self._replace(explanations=best_of_each([*more, *self.explanations], penalised))


class SingleFit(NamedTuple):
    """Best fit of one effect, the scan over its range, and the data, aligned where the effect asks for it."""

    fit: Fit
    scan: list[Evaluation]
    data: FitData


def base_fit(search: Search) -> Explained:
    """Fit the base model: nuisance parameters of the tests and uncertain parameters only.

    The data of the search are aligned to the fit then (``FitData.aligned_to``).
    """
    search.progress("base model")
    model = search.model()
    begun = of_beginnings(model)
    start = model.start(None, np.zeros(0))
    points = [replace(start, x=x) for x in model.uncertain_starts()]
    evaluations = begun.data.search_nuisances(begun, points)
    fit = grown(model, _halved(begun, evaluations, BASE_SCHEDULE, each=search.each))
    if len(model.uncertain) and fit.p < POSSIBLE:
        fit = search.tried(
            "nuisances held",
            fit,
            lambda fit: min(fit, grown(model, _from_held(search, begun, evaluations)), key=_chi2),
        )
    fit = _aligned(fit)
    return Explained(replace(search, data=fit.model.data), fit, [], {})


def _from_held(search: Search, model: Model, evaluations: Sequence[Evaluation]) -> Fit:
    """The base model from where nuisance parameters were held as stated.

    They may have made up for wrong values of uncertain parameters.
    """
    held = search.each(lambda evaluation: _nuisances_held(model, evaluation), evaluations)
    return _halved(model, held, BASE_SCHEDULE, each=search.each)


def refit_base(known: Explained) -> Explained:
    """Fit the base model again from where its best extension ended, and keep the better fit.

    Otherwise an extension would gain what the base model lost by stopping short of its minimum.
    """
    search, base, found, _ = known
    best = min(found, key=penalised, default=base)
    model, values = search.model(), best.model.values(best.x)
    x = np.clip(model.uncertain.at(values), model.low, model.high)
    _, at_rest = search.data.start()
    fit = minimise(model, model.evaluate(replace(best.point, x=x, warm=at_rest)))
    if fit.chi2 >= base.chi2 - SLIGHT:
        return known
    fit = _aligned(fit)
    return known._replace(search=replace(search, data=fit.model.data), base=fit)


def _aligned(fit: Fit) -> Fit:
    """The fit on data aligned to it, continued from there if its responses depend on the alignment."""
    model = fit.model.on(fit.model.data.aligned_to(fit.evaluation))
    fit = replace(fit, model=model)
    if model.data.needs_alignment(fit.effects):
        return minimise(model, model.evaluate(fit.point))
    return fit


def single_fits(known: Explained) -> Explained:
    """Fit every candidate effect by itself; one whose fit raises an error is no candidate any more."""
    search, base, _, _ = known

    def fitted(effect: str) -> SingleFit | None:
        try:
            one = single_fit(search, effect, base)
        except Exception as error:  # one odd effect must not take the others with it
            search.failed[effect] = error
            return None
        search.finished.append(one.fit)
        return one

    both = zip(search.effects, search.each(fitted, search.effects, "single effects"), strict=True)
    found: dict[str, SingleFit] = {effect: one for effect, one in both if one}
    aligned = [one.data for effect, one in found.items() if _brings_alignment(search.data, effect)]
    return Explained(
        replace(search, effects=tuple(found), data=aligned[-1] if aligned else search.data),
        base,
        [one.fit for one in found.values()],
        {effect: one.scan for effect, one in found.items()},
    )


def _brings_alignment(data: FitData, effect: str) -> bool:
    """Whether responses depend on the alignment of the data with this effect only."""
    return data.needs_alignment((effect,)) and not data.needs_alignment(())


def single_fit(search: Search, effect: str, base: Fit) -> SingleFit:
    """Fit one effect from starting points over its range, beside the fitted base model."""
    data, model, rough = search.data, search.model(effect), search.model(effect, tolerance=ROUGH)
    points = model.hypothesis.starts()
    beside_base = [model.start(base, x) for x in points]
    begun, rough_begun = of_beginnings(model), of_beginnings(rough)
    tried = begun.data.search_nuisances(rough_begun, beside_base)
    scan = tried if begun is model else rough.evaluate_all(beside_base)
    evaluations = best_per_value(tried)
    implausible = data.implausible(base.point) or bool(base.implausible)
    if implausible or _brings_alignment(data, effect) or model.hypothesis.switches:
        # Fitted without the effect, the base model's own parameters are, or may be, far from the truth.
        fresh = begun.data.search_nuisances(rough_begun, [model.start(None, x) for x in points])
        if model.hypothesis.switches and data.uncertain:
            fresh = [_with_own_numbers(rough_begun, each) for each in fresh]
        evaluations = evaluations + fresh
        if implausible:
            evaluations = evaluations + beside_stated(begun, fresh)
    schedule = SHORT_SCHEDULE if base.p >= POSSIBLE else SCHEDULE
    fit = grown(model, best_of(begun, evaluations, schedule))
    if _brings_alignment(data, effect):
        fit = _aligned(fit)
    return SingleFit(fit, scan, fit.model.data)


def _with_own_numbers(model: Model, start: Evaluation) -> Evaluation:
    """A start of an effect that switches, after a step of all numbers but its first, which is scanned.

    Such an effect makes another model of the base model, with other uncertain numbers. Where these stay as
    stated, or as fitted without the effect, the start closest to the truth may look worst.
    """
    return minimise(model.holding(0, start.point.x[0]), start, 1).evaluation


def best_of(model: Model, evaluations: Sequence[Evaluation], schedule: Sequence[Round] = SCHEDULE) -> Fit:
    """Fit from several evaluations by successive halving; the best fit is continued to its minimum.

    Fewer fits enter each round. Simulations of the evaluations may have a rougher tolerance than the model's.
    """
    starts = [evaluation.point for evaluation in _leading(evaluations, schedule[0].entering)]
    return _halved(model, model.evaluate_all(starts), schedule)


def _halved(
    model: Model,
    evaluations: Sequence[Evaluation],
    schedule: Sequence[Round],
    each: Callable[..., Iterable[Fit]] = map,
) -> Fit:
    """As ``best_of`` from evaluations by the model itself; ``each`` maps a function, perhaps in threads."""
    for entering, iterations in schedule:
        fits = list(each(partial(minimise, model, iterations=iterations), _leading(evaluations, entering)))
        evaluations = [fit.evaluation for fit in fits]
    best = min(fits, key=_chi2)
    return best if best.converged else minimise(model, best.evaluation)


def _chi2(each: Fit | Evaluation) -> float:
    return each.chi2


def _nuisances_held(model: Model, evaluation: Evaluation) -> Evaluation:
    """End of a fit from an evaluation while nuisance parameters stay as stated, evaluated by the model."""
    strict = model.on(model.data.held_as_stated())
    found = minimise(strict, strict.evaluate(evaluation.point), BRIEF)
    return model.evaluate(found.point)


def beside_stated(model: Model, evaluations: Sequence[Evaluation]) -> list[Evaluation]:
    """Ends of fits from the best evaluations while nuisance and uncertain parameters stay as stated.

    Evaluated by the model, in which all of these are free.
    """
    strict = replace(model, data=model.data.held_as_stated(), as_stated=True)
    leading = [each.point for each in _leading(evaluations, SCHEDULE[0].entering)]
    found = strict.evaluate_all([replace(point, x=point.x[: model.size]) for point in leading])
    for entering, iterations in SCHEDULE:
        found = [minimise(strict, each, iterations).evaluation for each in _leading(found, entering)]
    x = [np.r_[each.point.x, model.uncertain.mean] for each in found]
    return model.evaluate_all([replace(each.point, x=own) for each, own in zip(found, x, strict=True)])


def _leading(evaluations: Sequence[Evaluation], entering: int | None) -> list[Evaluation]:
    return sorted(evaluations, key=_chi2)[:entering]


def best_per_value(evaluations: Sequence[Evaluation]) -> list[Evaluation]:
    """The best evaluation at each value of one parameter, best first: not all starts are neighbours.

    It is the parameter with most values: the first one, or one that is fitted as its logarithm.
    """
    points = np.array([each.point.x for each in evaluations])
    most = int(np.argmax([np.unique(column).size for column in points.T])) if points.size else 0
    best: dict[float, Evaluation] = {}
    for evaluation in sorted(evaluations, key=_chi2):
        best.setdefault(float(evaluation.point.x[most]), evaluation)
    return list(best.values())
