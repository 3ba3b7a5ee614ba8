"""The accuracy ladder: how well the tests are explained by no effect, by one, by two, by more.

What loads a contact (a pressure, a weight, a temperature) may differ from record to record, and the model on
trial not know it. Then one number in all records leaves that difference, and a right cause looks inaccurate:
leading explanations are also fitted to each record by itself (``record_by_record``).

On a damper rig several causes at once are the rule. Where neither one effect nor two explain the tests, the
effects that are added next, with the gain of each, say what the model lacks; they are not named as causes.
Tests that are left out of the fits are the judge, as each further effect fits the others better
(``forward_selection``).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose import accuracy, verdict
from wedgesweep.diagnose.cross_validation import Predictor, held_out_accuracy
from wedgesweep.diagnose.explanation import ADEQUATE, NOTABLE
from wedgesweep.diagnose.least_squares import BRIEF, minimise, subset_fit
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.search import Search
from wedgesweep.effects import EFFECTS, go_together

# The most accurate explanations of each size are refined, that is fitted again at their accuracy: at most so
# many at a time, and at first only those within this factor of the best.
REFINED, FACTOR = 6, 3.0
# Number of best explanations of a size that must be refined, as their accuracies are compared.
COMPARED = 2
# Names of the steps after the ladder.
RECORD_BY_RECORD, FORWARD = "record by record", "forward selection"
# The most accurate explanations that these steps follow to the end.
FOLLOWED = 3
# Numbers of each record are told if they leave this share of what one number in all records leaves: less is
# gained by any effect, as several numbers fit better than one.
LEFT = 2.0 / 3.0
# Effects beside each other, at most: with more, none of a rig's few tests would be left to judge them.
MOST = 5
# Work that forward selection may spend, as a share of the work of the whole search.
SHARE = 1.0 / 6.0


@dataclass(frozen=True, eq=False)
class Rated:
    """An explanation with its accuracy, ``inf`` if it is adequate at no model error.

    ``fit``: at that accuracy, if it was refined. ``held_out``: accuracy of its predictions of tests that were
    left out of the fit; None if that was not evaluated.
    """

    explanation: Fit
    accuracy: float
    fit: Fit
    held_out: float | None = None

    @property
    def effects(self) -> tuple[str, ...]:
        return self.explanation.effects


@dataclass(frozen=True)
class Level:
    """Explanations of the same number of effects, the most accurate first."""

    rated: tuple[Rated, ...]

    @property
    def best(self) -> Rated:
        return self.rated[0]

    @property
    def rivals(self) -> tuple[Rated, ...]:
        return self.rated[1:]

    @property
    def distinct(self) -> float | None:
        """Accuracy of the best rival over that of the best; None without a rival or where both are 0."""
        if not self.rivals:
            return None
        best, rival = self.best.accuracy, self.rivals[0].accuracy
        if best == 0.0:
            return None if rival == 0.0 else inf
        return rival / best


def rough_ladder(search: Search, base: Fit, explanations: Sequence[Fit]) -> tuple[Level, ...]:
    """Rate the base model and every eligible explanation where its fit ended, without simulations."""
    allowed = [base, *filter(verdict.eligible, explanations)]
    rated = sorted(_surpassing_limits(search.each(rated_where_it_ended, allowed)), key=by_accuracy)
    sizes = sorted({len(each.effects) for each in rated})
    return tuple(Level(tuple(each for each in rated if len(each.effects) == size)) for size in sizes)


def _surpassing_limits(rated: Sequence[Rated]) -> list[Rated]:
    """Explanations without those that hardly gain on one with a limit of an effect in its place.

    They stay where something of another kind lies between both, which would profit from their absence.
    """
    accuracies = {frozenset(each.effects): each.accuracy for each in rated}

    def of_limit(each: Rated) -> float:
        """Accuracy of the best explanation with a limit in the place of an effect."""
        effects = frozenset(each.effects)
        simpler = (effects - {name} | {limit} for name in effects for limit in EFFECTS[name].limits)
        return min((accuracies.get(one, inf) for one in simpler), default=inf)

    hardly = [each for each in rated if of_limit(each) < verdict.CLEAR * each.accuracy]
    others = [each for each in rated if each not in hardly]

    def others_between(each: Rated) -> bool:
        alike = (one.accuracy for one in others if len(one.effects) == len(each.effects))
        return any(each.accuracy < accuracy < of_limit(each) for accuracy in alike)

    return [each for each in rated if each not in hardly or others_between(each)]


def ladder(search: Search, base: Fit, explanations: Sequence[Fit], predict: Predictor) -> tuple[Level, ...]:
    """Rate the base model and every eligible explanation, and refine the leading ones.

    The best one of each level also predicts tests that are left out of its fit.
    """
    rough = rough_ladder(search, base, explanations)
    return tuple(level_of(search, level.rated, predict) for level in rough)


def rated_where_it_ended(fit: Fit) -> Rated:
    """An explanation with the accuracy of its fit as it is."""
    return Rated(fit, accuracy.of_responses([(fit.model.data, fit.evaluation)], fit.dof), fit)


def level_of(search: Search, rough: Sequence[Rated], predict: Predictor) -> Level:
    """The explanations of one size, best first.

    The leading ones are refined, by accuracy and by misfit: with the weights of noise alone a right cause
    whose size differs from record to record ends far from its accuracy. So is any other that would rank among
    the COMPARED best without it.
    """
    waiting, done = list(rough), list[Rated]()
    chosen = [each for each in waiting[:REFINED] if each.accuracy <= FACTOR * waiting[0].accuracy]
    by_misfit = sorted(waiting, key=lambda each: each.explanation.penalised)[:COMPARED]
    chosen += [each for each in by_misfit if each not in chosen]
    while chosen:
        done = sorted([*done, *search.each(_refined, chosen)], key=by_accuracy)
        waiting = [each for each in waiting if each not in chosen]
        chosen = _still_to_refine(waiting, done)
    order = sorted([*done, *waiting], key=by_accuracy)
    return Level((_with_held_out_accuracy(order[0], predict), *order[1:]))


def _still_to_refine(waiting: list[Rated], done: list[Rated]) -> list[Rated]:
    """Of explanations that are not refined, best first, those that would rank among the COMPARED best."""
    if len(done) < COMPARED:
        return waiting[: COMPARED - len(done)]
    last = by_accuracy(done[COMPARED - 1])
    return [each for each in waiting[:REFINED] if by_accuracy(each) < last]


def _with_held_out_accuracy(best: Rated, predict: Predictor) -> Rated:
    if best.accuracy == inf:
        return best
    return replace(best, held_out=held_out_accuracy(best.fit, predict))


def _refined(each: Rated) -> Rated:
    """An explanation fitted at its accuracy; numbers that differ from test to test make it less accurate."""
    found = accuracy.refined(each.fit)
    size = found.size
    if size == 0.0 and each.explanation.p_value < ADEQUATE:
        size = accuracy.with_constant_parameters(found.fit)
    return replace(each, accuracy=size, fit=found.fit)


def by_accuracy(each: Rated) -> tuple[float, float]:
    """Key by which explanations of a size are ranked: accuracy, then penalised chi-squared."""
    return each.accuracy, each.explanation.penalised


class ByRecord(NamedTuple):
    """An explanation with numbers of its own in each record.

    ``accuracy``: of the fits together; ``fits``: to each record, after its name.
    """

    effects: tuple[str, ...]
    accuracy: float
    fits: tuple[tuple[str, Fit], ...]


def record_by_record(search: Search, level: Level) -> tuple[ByRecord, ...]:
    """The leading explanations of a level by themselves in each record, the most accurate first.

    None where that explains the records hardly better, or where there is one record.
    """
    records = search.data.tests_of_records
    if len(records) < 2:
        return ()
    found = search.each(lambda each: _of_records(each, records), level.rated[:FOLLOWED])
    found = sorted(found, key=lambda each: each.accuracy)
    return tuple(found) if found[0].accuracy < LEFT * level.best.accuracy else ()


def _of_records(rated: Rated, records: Sequence[tuple[str, np.ndarray]]) -> ByRecord:
    fits = [(name, accuracy.refined(subset_fit(rated.fit, rows)).fit) for name, rows in records]
    together = [(fit.model.data, fit.evaluation) for _, fit in fits]
    dof = sum(fit.dof for _, fit in fits)
    return ByRecord(rated.effects, accuracy.of_responses(together, dof), tuple(fits))


def forward_selection(
    search: Search, explanations: Sequence[Fit], levels: Sequence[Level], predict: Predictor
) -> tuple[Level, ...]:
    """The levels of the ladder, and one more for each effect that is added to its best pair.

    None is added where no pair was fitted, or where it predicts hardly better than one effect.
    """
    found = list(levels)
    if len(found[-1].best.effects) < 2 or not _gained(*found[-2:]):
        return tuple(found)
    singles = {each.effects[0]: each for each in explanations if len(each.effects) == 1}
    search.budget.grant(SHARE * search.budget.total)
    while len(found[-1].best.effects) < MOST:
        rated = _with_one_more(search, found[-1].best, singles)
        level = level_of(search, rated, predict) if rated else None
        if level is None or not _gained(found[-1], level):
            break
        found.append(level)
    return tuple(found)


def _gained(before: Level, after: Level) -> bool:
    """Whether a level predicts tests left out clearly better than the one with an effect less."""
    was, now = before.best.held_out, after.best.held_out
    return was is not None and now is not None and now < NOTABLE * was


def _with_one_more(search: Search, best: Rated, singles: Mapping[str, Fit]) -> list[Rated]:
    """The best explanation with each other effect that can go with it; only the leading ones, best first."""
    others = [
        single
        for name, single in singles.items()
        if name not in best.effects and go_together((*best.effects, name))
    ]
    begun = search.each_affordable(lambda single: _begun(search, best, single), others, FORWARD)
    leading = sorted(begun, key=lambda fit: fit.chi2)[:FOLLOWED]
    found = search.each(rated_where_it_ended, leading)
    return sorted(found, key=by_accuracy)


def _begun(search: Search, best: Rated, single: Fit) -> Fit:
    """A fit under the model error of the best explanation, with one effect more.

    The new effect starts as it was fitted by itself, or so weak that it changes nothing.
    """
    fit = best.fit
    model = search.model(*fit.effects, *single.effects)
    model = model.on(fit.model.data.with_model_error(best.accuracy))
    alone, hypothesis = single.x[: single.model.size], single.model.hypothesis
    starts = [np.r_[fit.x[: fit.model.size], x] for x in (alone, hypothesis.near_neutral(alone))]
    evaluations = model.evaluate_all([model.start(fit, x) for x in starts])
    return minimise(model, min(evaluations, key=lambda each: each.chi2), BRIEF)
