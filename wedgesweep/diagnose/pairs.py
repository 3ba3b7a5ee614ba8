"""Fits of two effects at a time.

A weak effect alone may be half of the right pair, so that no effect is dropped for its own fit: beside
each of the best single fits every other effect is tried. Where it starts is chosen as if responses added;
what promises most after a few iterations on some of the tests goes on to more of both (successive halving).
Where none will do, effects that only show in pairs are tried beside every other as well, and the best pairs
begin once more, from starts that are no neighbours.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import permutations
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose import simulation, verdict
from wedgesweep.diagnose.model import Fit, Model, Trial
from wedgesweep.diagnose.refine import ITERATIONS, refine, restrict
from wedgesweep.diagnose.search import Explanation, Search, best_of_each, penalised

# Single fits beside which every other effect is tried, and starting points of the other effect.
PARTNERS, STARTS = 8, 2
# Iterations of the rounds of improvement on some of the tests; then all tests. So many pairs enter the last
# round, or the second where one nearly will do by then: its misfit is this many times noise at the most.
ROUNDS, ENTERING, NEARLY = (1, 2, 5), 40, 2.0
GOING_ON = 8
# Where one pair will do, others with this many times its misfit go no further; a few always do. A start is
# that far behind the fit beside which it is, too.
BEHIND, SEVERAL = 5.0, 4
# Tests that the first look takes.
FEW = 6
# Where no pair will do: starting points of another look at the best pairs, and how many pairs are the best.
STARTS_APART, AGAIN = 4, 4
# Best pairs of which each effect is tried beside others, where no pair will do.
SWAPPED = 2
# Pairs whose misfit is this close to the best have each of their effects fitted alone again.
CLOSE = 50.0
# Least change (squared, in noise) of a response that says something.
SEEN = 4.0
# An effect may be this much weaker or stronger than where it was tried.
SCALES = (0.1, 2.0)


class Alone(NamedTuple):
    """What is known of one effect: its fit, on all tests and on the few that it leaves unexplained.

    ``x`` (n, k): its numbers over their range; ``changes`` (n, m): what they change of the base responses.
    """

    fit: Fit
    few: Fit
    x: np.ndarray
    changes: np.ndarray


def pairs(search: Search, base: Fit, singles: Sequence[Explanation]) -> list[Explanation]:
    """The best fits of pairs, best first."""
    alone = {each.effects[0]: _alone(search, base, each.fit) for each in singles}
    leading = sorted(alone, key=lambda effect: alone[effect].fit.q)[:PARTNERS]
    beside = [(alone[one], alone[other]) for one in leading for other in alone if one != other]
    found = _followed(search, base, beside, False, GOING_ON)
    if verdict.none_will_do(found):
        # Alone they stood behind, beside others they show: each may be the first of a pair, too.
        shown = dict.fromkeys(effect for each in found[:AGAIN] for effect in each.effects)
        beside = [
            (alone[one], alone[other]) for one in shown for other in alone if one not in (*leading, other)
        ]
        found = best_of_each(found + _followed(search, base, beside, False, GOING_ON), penalised)
    if verdict.none_will_do(found):
        found = best_of_each(found + _swapped(search, base, alone, found), penalised)
    if verdict.none_will_do(found):
        ways = [pair for each in found[:GOING_ON] for pair in permutations(each.effects)]
        beside = [(alone[one], alone[other]) for one, other in ways]
        found += _followed(search, base, beside, True, AGAIN)
    return best_of_each(found, penalised)


def _swapped(
    search: Search, base: Fit, alone: Mapping[str, Alone], found: Sequence[Explanation]
) -> list[Explanation]:
    """Pairs in which an effect keeps its numbers from one of the best pairs, and the other one is another."""
    parts = [(pair.fit, effect) for pair in found[:SWAPPED] for effect in pair.effects]
    kept = search.each(lambda part: _within(search, *part), parts)
    beside = [
        (first, other)
        for (pair, _), first in zip(parts, kept, strict=True)
        for effect, other in alone.items()
        if effect not in pair.effects and first.fit.trial.found
    ]
    return _followed(search, base, beside, False, GOING_ON)


def _followed(
    search: Search, base: Fit, beside: Sequence[tuple[Alone, Alone]], apart: bool, going_on: int
) -> list[Explanation]:
    """Fits of second effects beside first ones, the best first.

    ``apart``: from several starts of each that are no neighbours.
    """
    jobs = [(first, other) for first, other in beside if len(other.x)]
    begun = search.each(lambda job: _begin(search, job[0], job[1], apart), jobs)
    fits = [fit for some in begun for fit in some if np.isfinite(fit.q)]
    fits = _further(search, fits if apart else _best_of_pairs(fits), ROUNDS[0])
    if any(fit.q < NEARLY * fit.dof for fit in fits):
        fits = _best_of_pairs(fits)[:ENTERING]
    fits = _further(search, fits, ROUNDS[1])
    fits = _further(search, fits if apart else _hopeful(fits)[:ENTERING], ROUNDS[2])
    found = search.each(lambda fit: _finish(search, base, fit), _hopeful(fits)[:going_on])
    return search.around(found)


def _further(search: Search, fits: Sequence[Fit], iterations: int) -> list[Fit]:
    return search.each(lambda fit: refine(fit.model, fit.trial, iterations), fits)


def _best_of_pairs(fits: Sequence[Fit]) -> list[Fit]:
    return best_of_each(fits, lambda fit: fit.q)


def _hopeful(fits: Sequence[Fit]) -> list[Fit]:
    """The best fit of each pair, the best first, without those that are far behind one that will do."""
    found = _best_of_pairs(fits)
    if not found or found[0].p < verdict.ADEQUATE:
        return found
    near = [fit for fit in found if fit.q < BEHIND * found[0].q]
    return found[: max(len(near), SEVERAL)]


def halves(search: Search, both: Sequence[Explanation]) -> list[Explanation]:
    """Either effect of the leading pairs alone, from its numbers in the pair.

    A pair whose other half does nothing shows a minimum that the single fit had missed.
    """
    if not both:
        return []
    close = [each for each in both if each.fit.q - both[0].fit.q < CLOSE]
    jobs = [(pair.fit, effect) for pair in close for effect in pair.effects]
    parts = search.each(lambda job: _part(search, *job), jobs)
    return [search.explanation(fit) for fit in _further(search, parts, ITERATIONS)]


def _part(search: Search, pair: Fit, effect: str) -> Fit:
    """One effect of a pair alone, at its numbers there."""
    model = search.model(effect)
    trial = model.trial(model.start(pair, model.hypothesis.at(pair.values)))
    return Fit(model, trial, np.zeros((trial.point.x.size,) * 2), False)


def _within(search: Search, pair: Fit, effect: str) -> Alone:
    """One effect of a pair at its numbers there, to be the first of others: no other numbers are tried."""
    fit = _part(search, pair, effect)
    nothing = np.zeros((0, fit.model.size))
    return Alone(fit, _few(fit), nothing, nothing)


def _few(fit: Fit) -> Fit:
    """The same point on the tests that it leaves most of."""
    return restrict(fit, np.sort(np.argsort(-fit.trial.by_test)[:FEW]))


def _alone(search: Search, base: Fit, fit: Fit) -> Alone:
    """A single fit with everything that was simulated of its effect."""
    trials = [trial for trial in (*search.along[fit.effects[0]], fit.trial) if trial.found]
    size = fit.model.size
    changes = np.array([(base.trial.residual - trial.residual).ravel() for trial in trials])
    x = np.array([trial.point.x[:size] for trial in trials])
    seen = np.array([change @ change > SEEN for change in changes], dtype=bool)
    return Alone(fit, _few(fit), x[seen], changes[seen] if seen.any() else changes[:0])


def _starts(first: Fit, other: Alone, apart: bool) -> np.ndarray:
    """Points (n, k) of the other effect that go best with a fit, if responses add.

    ``apart``: the best one of each value of its last number.
    """
    residual = first.trial.residual.ravel()
    size, along = (other.changes**2).sum(1), other.changes @ residual
    scale = np.clip(along / size, *SCALES)
    points = other.x[np.argsort(scale**2 * size - 2.0 * scale * along)]
    if apart and points.shape[1] > 1:
        _, at = np.unique(points[:, -1], return_index=True)
        return points[np.sort(at)][:STARTS_APART]
    return points[: STARTS_APART if apart else STARTS]


def _begin(search: Search, first: Alone, other: Alone, apart: bool) -> list[Fit]:
    """Starts of a second effect beside a fitted one, on some of the tests: the best, or all if ``apart``."""
    fit, few = first.fit, first.few
    hypothesis = search.model(*fit.effects, *other.fit.effects).hypothesis
    model = Model(few.model.problem, hypothesis, few.model.reference, simulation.ROUGH)
    known = fit.x[: fit.model.size]

    def tried(points: np.ndarray) -> list[Trial]:
        return model.trials([model.start(few, np.r_[known, x]) for x in points])

    trials = tried(_starts(fit, other, apart))
    if not apart and min(each.q for each in trials) > BEHIND * few.q:
        # Responses do not add where a test sticks that slid: what acts least leaves them where they are.
        trials += tried(other.fit.model.hypothesis.mild(other.x[np.argmin((other.changes**2).sum(1))])[None])
    chosen = trials if apart else [min(trials, key=lambda each: each.q)]
    return [Fit(model, each, np.zeros((each.point.x.size,) * 2), False) for each in chosen]


def _finish(search: Search, base: Fit, first: Fit) -> Explanation:
    """A fit on all tests from one on some of them."""
    effects = first.effects
    model = search.model(*effects)
    start = model.start(base, first.x[: model.size])
    start = replace(start, x=np.r_[first.x[: model.size], start.x[model.size :]])
    fit = refine(model, model.trial(start))
    search.progress(" + ".join(effects))
    return search.explanation(fit)
