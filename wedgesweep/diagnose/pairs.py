"""Fits of two effects at a time.

A weak effect alone may be half of the right pair, so that no effect is dropped for its own fit: conditional
each of the best single fits every other effect is tried. Where it starts is chosen as if responses added;
what promises most after a few iterations on some of the tests goes on to more of both (successive halving).
Where none will do, effects that only show in pairs are tried beside every other as well, and the best
pairs begin once more, from starts that are no neighbours.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import permutations
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.least_squares import ITERATIONS, refine, subset_fit
from wedgesweep.diagnose.search import Explanation, Search, best_of_each, penalised
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.model import Evaluation, Fit, Model

# Single fits conditional which every other effect is tried, and starting points of the other effect.
PARTNERS, STARTS = 8, 2
# Iterations of the rounds of improvement on some of the tests; then all tests. So many pairs enter the last
# round, or the second where one nearly will do by then: its misfit is this many times noise at the most.
ROUNDS, ENTERING, NEARLY = (1, 2, 5), 40, 2.0
GOING_ON = 8
# Where one pair will do, others with this many times its misfit go no further; a few always do. A start is
# that far behind the fit conditional which it is, too.
BEHIND, SEVERAL = 5.0, 4
# Tests that the first look takes.
SUBSET = 6
# Where no pair will do: starting points of another look at the best pairs, and how many pairs are the best.
DIVERSE_STARTS, REFITTED_PAIRS = 4, 4
# Best pairs of which each effect is tried conditional others, where no pair will do.
SWAPPED = 2
# Pairs whose misfit is this close to the best have each of their effects fitted alone again.
NEAR_BEST = 50.0
# Least change (squared, in noise) of a response that says something.
SEEN = 4.0
# An effect may be this much weaker or stronger than where it was tried.
SCALES = (0.1, 2.0)


class SingleScan(NamedTuple):
    """What is known of one effect: its fit, on all tests and on the few that it leaves unexplained.

    ``x`` (n, k): its numbers over their range; ``changes`` (n, m): what they change of the base responses.
    """

    fit: Fit
    subset: Fit
    x: np.ndarray
    changes: np.ndarray


def pairs(search: Search, base: Fit, singles: Sequence[Explanation]) -> list[Explanation]:
    """The best fits of pairs, best first."""
    alone = {each.effects[0]: _single_scan(search, base, each.fit) for each in singles}
    leading = sorted(alone, key=lambda effect: alone[effect].fit.chi2)[:PARTNERS]
    conditional = [(alone[one], alone[other]) for one in leading for other in alone if one != other]
    found = _followed(search, base, conditional, False, GOING_ON)
    if verdict.none_adequate(found):
        # Alone they stood behind, conditional others they show: each may be the first of a pair, too.
        shown = dict.fromkeys(effect for each in found[:REFITTED_PAIRS] for effect in each.effects)
        conditional = [
            (alone[one], alone[other]) for one in shown for other in alone if one not in (*leading, other)
        ]
        found = best_of_each(found + _followed(search, base, conditional, False, GOING_ON), penalised)
    if verdict.none_adequate(found):
        found = best_of_each(found + _swapped(search, base, alone, found), penalised)
    if verdict.none_adequate(found):
        ways = [pair for each in found[:GOING_ON] for pair in permutations(each.effects)]
        conditional = [(alone[one], alone[other]) for one, other in ways]
        found += _followed(search, base, conditional, True, REFITTED_PAIRS)
    return best_of_each(found, penalised)


def _swapped(
    search: Search, base: Fit, alone: Mapping[str, SingleScan], found: Sequence[Explanation]
) -> list[Explanation]:
    """Pairs in which an effect keeps its numbers from one of the best pairs, and the other one is another."""
    parts = [(pair.fit, effect) for pair in found[:SWAPPED] for effect in pair.effects]
    kept = search.each(lambda part: _within(search, *part), parts)
    conditional = [
        (first, other)
        for (pair, _), first in zip(parts, kept, strict=True)
        for effect, other in alone.items()
        if effect not in pair.effects and first.fit.evaluation.found
    ]
    return _followed(search, base, conditional, False, GOING_ON)


def _followed(
    search: Search,
    base: Fit,
    conditional: Sequence[tuple[SingleScan, SingleScan]],
    diverse: bool,
    going_on: int,
) -> list[Explanation]:
    """Fits of second effects conditional first ones, the best first.

    ``diverse``: from several starts of each that are no neighbours.
    """
    jobs = [(first, other) for first, other in conditional if len(other.x)]
    begun = search.each(lambda job: _begin(search, job[0], job[1], diverse), jobs)
    fits = [fit for some in begun for fit in some if np.isfinite(fit.chi2)]
    fits = _further(search, fits if diverse else _best_of_pairs(fits), ROUNDS[0])
    if any(fit.chi2 < NEARLY * fit.dof for fit in fits):
        fits = _best_of_pairs(fits)[:ENTERING]
    fits = _further(search, fits, ROUNDS[1])
    fits = _further(search, fits if diverse else _hopeful(fits)[:ENTERING], ROUNDS[2])
    found = search.each(lambda fit: _finish(search, base, fit), _hopeful(fits)[:going_on])
    return search.around(found)


def _further(search: Search, fits: Sequence[Fit], iterations: int) -> list[Fit]:
    return search.each(lambda fit: refine(fit.model, fit.evaluation, iterations), fits)


def _best_of_pairs(fits: Sequence[Fit]) -> list[Fit]:
    return best_of_each(fits, lambda fit: fit.chi2)


def _hopeful(fits: Sequence[Fit]) -> list[Fit]:
    """The best fit of each pair, the best first, without those that are far behind one that will do."""
    found = _best_of_pairs(fits)
    if not found or found[0].p < verdict.ADEQUATE:
        return found
    near = [fit for fit in found if fit.chi2 < BEHIND * found[0].chi2]
    return found[: max(len(near), SEVERAL)]


def component_fits(search: Search, both: Sequence[Explanation]) -> list[Explanation]:
    """Either effect of the leading pairs alone, from its numbers in the pair.

    A pair whose other half does nothing shows a minimum that the single fit had missed.
    """
    if not both:
        return []
    close = [each for each in both if each.fit.chi2 - both[0].fit.chi2 < NEAR_BEST]
    jobs = [(pair.fit, effect) for pair in close for effect in pair.effects]
    parts = search.each(lambda job: _part(search, *job), jobs)
    return [search.explanation(fit) for fit in _further(search, parts, ITERATIONS)]


def _part(search: Search, pair: Fit, effect: str) -> Fit:
    """One effect of a pair alone, at its numbers there."""
    model = search.model(effect)
    evaluation = model.evaluate(model.start(pair, model.hypothesis.at(pair.values)))
    return Fit(model, evaluation, np.zeros((evaluation.point.x.size,) * 2), False)


def _within(search: Search, pair: Fit, effect: str) -> SingleScan:
    """One effect of a pair at its numbers there, to be the first of others: no other numbers are tried."""
    fit = _part(search, pair, effect)
    nothing = np.zeros((0, fit.model.size))
    return SingleScan(fit, _subset(fit), nothing, nothing)


def _subset(fit: Fit) -> Fit:
    """The same point on the tests that it leaves most of."""
    return subset_fit(fit, np.sort(np.argsort(-fit.evaluation.chi2_by_test)[:SUBSET]))


def _single_scan(search: Search, base: Fit, fit: Fit) -> SingleScan:
    """A single fit with everything that was simulated of its effect."""
    evaluations = [
        evaluation for evaluation in (*search.scans[fit.effects[0]], fit.evaluation) if evaluation.found
    ]
    size = fit.model.size
    changes = np.array(
        [(base.evaluation.residual - evaluation.residual).ravel() for evaluation in evaluations]
    )
    x = np.array([evaluation.point.x[:size] for evaluation in evaluations])
    seen = np.array([change @ change > SEEN for change in changes], dtype=bool)
    return SingleScan(fit, _subset(fit), x[seen], changes[seen] if seen.any() else changes[:0])


def _starts(first: Fit, other: SingleScan, diverse: bool) -> np.ndarray:
    """Points (n, k) of the other effect that go best with a fit, if responses add.

    ``diverse``: the best one of each value of its last number.
    """
    residual = first.evaluation.residual.ravel()
    size, along = (other.changes**2).sum(1), other.changes @ residual
    scale = np.clip(along / size, *SCALES)
    points = other.x[np.argsort(scale**2 * size - 2.0 * scale * along)]
    if diverse and points.shape[1] > 1:
        _, at = np.unique(points[:, -1], return_index=True)
        return points[np.sort(at)][:DIVERSE_STARTS]
    return points[: DIVERSE_STARTS if diverse else STARTS]


def _begin(search: Search, first: SingleScan, other: SingleScan, diverse: bool) -> list[Fit]:
    """Starts of a second effect beside a fitted one, on some of the tests: the best, or all."""
    fit, subset = first.fit, first.subset
    hypothesis = search.model(*fit.effects, *other.fit.effects).hypothesis
    model = Model(subset.model.data, hypothesis, subset.model.reference, simulation.ROUGH)
    known = fit.x[: fit.model.size]

    def tried(points: np.ndarray) -> list[Evaluation]:
        return model.evaluate_all([model.start(subset, np.r_[known, x]) for x in points])

    evaluations = tried(_starts(fit, other, diverse))
    if not diverse and min(each.chi2 for each in evaluations) > BEHIND * subset.chi2:
        # Responses do not add where a test sticks that slid: what acts least leaves them where they are.
        evaluations += tried(
            other.fit.model.hypothesis.near_neutral(other.x[np.argmin((other.changes**2).sum(1))])[None]
        )
    chosen = evaluations if diverse else [min(evaluations, key=lambda each: each.chi2)]
    return [Fit(model, each, np.zeros((each.point.x.size,) * 2), False) for each in chosen]


def _finish(search: Search, base: Fit, first: Fit) -> Explanation:
    """A fit on all tests from one on some of them."""
    effects = first.effects
    model = search.model(*effects)
    start = model.start(base, first.x[: model.size])
    start = replace(start, x=np.r_[first.x[: model.size], start.x[model.size :]])
    fit = refine(model, model.evaluate(start))
    search.progress(" + ".join(effects))
    return search.explanation(fit)
