"""Fits of two effects at a time.

A weak effect by itself may be one component of the right pair, so no effect is dropped for its own fit:
every other effect is tried together with each of the best single fits. The second effect starts where it
would fit best if responses added. The most promising pairs are then followed further, on more tests
(successive halving).
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.evaluation import Evaluation
from wedgesweep.diagnose.explanation import best_of_each, penalised
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.least_squares import BEGINNINGS, fit_from, minimise, of_beginnings, subset_fit
from wedgesweep.diagnose.model import ROUGH, Fit, unfitted
from wedgesweep.diagnose.search import LEADING, Round, Scans, Search
from wedgesweep.diagnose.work import SLIGHT
from wedgesweep.effects import EFFECTS, go_together

# Starting points of the second effect.
STARTS = 2
# Rounds on the subset of tests; the LEADING pairs are then fitted to all tests.
ROUNDS = (Round(None, 1), Round(40, 2), Round(40, 5))
# Share of each of these tests that counts in each round: weak friction shows at the end of a release only.
SHARES = (*BEGINNINGS, 1.0)
# Once a pair is adequate, pairs with this many times its misfit are dropped, but never SEVERAL of the best.
# A start of a pair is poor if its misfit is this many times that of the first effect by itself.
BEHIND, SEVERAL = 5.0, 4
# Tests on which pairs are fitted first.
SUBSET = 6
# Range of the factor by which changes of the second effect may be scaled where its best start is looked for.
SCALES = (0.1, 2.0)
# Name by which a spent budget tells what it left out.
PAIRS = "pairs with one of the best single effects"


class SingleScan(NamedTuple):
    """What is known of one effect.

    ``fit``: to all tests; ``subset``: the same fit on the few tests that it fits worst; ``begun``: the same
    on their beginnings. ``x`` (n, k): its parameters where it was evaluated and changed the responses, or all
    of them if it never did; ``changes`` (n, m): how it changed those of the base model, whitened, all tests
    in a row.
    """

    fit: Fit
    subset: Fit
    begun: Fit
    x: np.ndarray
    changes: np.ndarray

    @property
    def effects(self) -> tuple[str, ...]:
        return self.fit.effects


class Combination(NamedTuple):
    """Two effects to be fitted together: the first starts as it was fitted, the second where it fits best."""

    first: SingleScan
    second: SingleScan

    @property
    def effects(self) -> tuple[str, ...]:
        return (*self.first.effects, *self.second.effects)

    @property
    def shows(self) -> bool:
        """Whether the second effect changes responses by itself, or what the first one adds."""
        (name,) = self.second.effects
        beside = bool(len(self.second.x)) and not set(EFFECTS[name].acts_on).isdisjoint(self.first.effects)
        return beside or bool(self.second.changes.any())


def fit_pairs(search: Search, base: Fit, singles: Sequence[Fit], scans: Scans) -> list[Fit]:
    """Fit pairs of effects, and return them best first; ``singles``: best fit of each effect by itself."""
    known = {each.effects[0]: single_scan(base, each, scans[each.effects[0]]) for each in singles}
    leading = sorted(known, key=lambda effect: known[effect].fit.chi2)[:LEADING]
    both = [Combination(known[one], known[other]) for one in leading for other in known if one != other]
    useful = [each for each in both if each.shows and go_together(each.effects)]
    begun = search.each_affordable(lambda each: starting_fit(search, each), useful, PAIRS)
    fits = [fit for fit in begun if np.isfinite(fit.chi2)]
    for (entering, iterations), share in zip(ROUNDS, SHARES, strict=True):
        fits = _continued(search, known, promising(fits)[:entering], iterations, share)
    completed = SEVERAL if search.budget.left <= 0.0 else LEADING
    found = search.each(lambda fit: _complete(search, base, known, fit), promising(fits)[:completed])
    return best_of_each(found, penalised)


def _continued(
    search: Search, known: Mapping[str, SingleScan], fits: Sequence[Fit], iterations: int, share: float
) -> list[Fit]:
    """Fits, the best first, continued on a share of their tests; as they are once the budget is spent."""

    def followed(fit: Fit) -> Fit:
        model = of_beginnings(fit.model.on(known[fit.effects[0]].subset.model.data), share)
        same = model.data is fit.model.data
        return minimise(model, fit.evaluation if same else model.evaluate(fit.point), iterations)

    found = search.each_affordable(followed, fits, f"{PAIRS}, followed further")
    return [*found, *fits[len(found) :]]


def promising(fits: Sequence[Fit]) -> list[Fit]:
    """The best fit of each pair, best first, without those far behind an adequate one."""
    found = best_of_each(fits, _per_freedom)
    if not found or found[0].p < verdict.ADEQUATE:
        return found
    near = [fit for fit in found if _per_freedom(fit) < BEHIND * _per_freedom(found[0])]
    return found[: max(len(near), SEVERAL)]


def _per_freedom(fit: Fit) -> float:
    """Misfit by which fits to longer and shorter parts of tests compare."""
    return fit.chi2 / max(fit.dof, 1)


def _worst_tests(fit: Fit) -> Fit:
    """The same point on the SUBSET of tests with the largest misfit."""
    return subset_fit(fit, np.sort(np.argsort(-fit.evaluation.chi2_by_test)[:SUBSET]))


def _at_beginnings(fit: Fit) -> Fit:
    """The same point on the beginnings of a fit's tests."""
    model = of_beginnings(fit.model)
    return fit if model is fit.model else unfitted(model, model.evaluate(fit.point))


def single_scan(base: Fit, fit: Fit, scan: Sequence[Evaluation]) -> SingleScan:
    """A single fit with all evaluations of its effect that have responses and change them."""
    evaluations = [each for each in (*scan, fit.evaluation) if each.found]
    changes = np.array([(base.evaluation.residual - each.residual).ravel() for each in evaluations])
    x = np.array([each.point.x[: fit.model.size] for each in evaluations])
    seen = np.array([change @ change > SLIGHT for change in changes], dtype=bool)
    subset = _worst_tests(fit)
    begun = _at_beginnings(subset)
    if not seen.any():
        return SingleScan(fit, subset, begun, x, np.zeros_like(changes))
    return SingleScan(fit, subset, begun, x[seen], changes[seen])


def _starts(first: Fit, second: SingleScan) -> np.ndarray:
    """Points (STARTS, k) of the second effect that fit best beside the first if responses add.

    All of its points, if it shows beside the first only.
    """
    if not second.changes.any():
        return second.x
    residual = first.evaluation.residual.ravel()
    size, along = (second.changes**2).sum(1), second.changes @ residual
    scale = np.clip(along / size, *SCALES)
    return second.x[np.argsort(scale**2 * size - 2.0 * scale * along)][:STARTS]


def starting_fit(search: Search, combination: Combination) -> Fit:
    """The fit of a combination on a subset of the tests, before its first iteration."""
    fit, begun, second = combination.first.fit, combination.first.begun, combination.second
    model = search.model(*combination.effects, tolerance=ROUGH)
    model = model.on(begun.model.data)
    first_x = fit.x[: fit.model.size]

    def best(points: np.ndarray) -> Evaluation:
        evaluations = model.evaluate_all([model.start(begun, np.r_[first_x, x]) for x in points])
        return min(evaluations, key=lambda each: each.chi2)

    start = best(_starts(fit, second))
    if start.chi2 > BEHIND * begun.chi2:
        # Responses do not add where a test sticks that had slid; a weak effect leaves them as they are.
        weakest = second.x[np.argmin((second.changes**2).sum(1))]
        neutral = best(second.fit.model.hypothesis.near_neutral(weakest)[None])
        start = min(start, neutral, key=lambda each: each.chi2)
    return unfitted(model, start)


def _complete(search: Search, base: Fit, singles: Mapping[str, SingleScan], subset: Fit) -> Fit:
    """A fit to all tests, from the end of a fit to a subset of them.

    Nuisance parameters of each test start as in the base fit, as in the fit of one of the effects by itself,
    or as stated, whichever fits the beginning of this test best.
    """
    model = search.model(*subset.effects)
    known = [base, *(singles[effect].fit for effect in subset.effects), None]
    starts = [replace(model.start(fit, subset.x[: model.size]), x=subset.x) for fit in known]
    found = fit_from(model, replace(starts[0], nuisance=of_beginnings(model).best_nuisances(starts)))
    search.finished.append(found)
    return found


def simpler(search: Search, pair: Fit) -> list[Fit]:
    """Either effect of a pair by itself, and the pair with a special case of one, from the pair's numbers.

    A pair whose other effect does nothing, or nothing beyond its special case, reveals a minimum that these
    fits had missed.
    """
    values = pair.values
    begun = [{effect: values[effect]} for effect in pair.effects]
    for effect, other in (pair.effects, pair.effects[::-1]):
        for special in EFFECTS[effect].contains:
            keys = {quantity.key for quantity in EFFECTS[special].quantities if quantity.search}
            if special in search.effects and special != other and keys <= values[effect].keys():
                begun.append({special: values[effect], other: values[other]})

    def followed(numbers: Values) -> Fit:
        model = search.model(*numbers)
        start = model.start(pair, model.hypothesis.at(numbers))
        return minimise(model, model.evaluate(start))

    return search.each(followed, begun)
