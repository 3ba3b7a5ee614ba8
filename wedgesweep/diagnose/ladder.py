"""The accuracy ladder: how well the tests are explained by no effect, by one, by two, by more."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf

from wedgesweep.diagnose import accuracy, verdict
from wedgesweep.diagnose.cross_validation import Predictor, held_out_accuracy
from wedgesweep.diagnose.explanation import ADEQUATE, Explanation
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.search import Search
from wedgesweep.effects import EFFECTS

# The most accurate explanations of each size are refined, that is fitted again at their accuracy: at most so
# many at a time, and at first only those within this factor of the best.
REFINED, FACTOR = 6, 3.0
# Number of best explanations of a size that must be refined, as their accuracies are compared.
COMPARED = 2


@dataclass(frozen=True, eq=False)
class Rated:
    """An explanation with its accuracy, ``inf`` if it is adequate at no model error.

    ``fit``: at that accuracy, if it was refined. ``held_out``: accuracy of its predictions of tests that were
    left out of the fit; None if that was not evaluated.
    """

    explanation: Explanation
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


def rough_ladder(search: Search, base: Explanation, explanations: Sequence[Explanation]) -> tuple[Level, ...]:
    """Rate the base model and every eligible explanation where its fit ended, without simulations."""
    allowed = [base, *filter(verdict.eligible, explanations)]
    rated = sorted(_surpassing_limits(search.each(rated_where_it_ended, allowed)), key=by_accuracy)
    sizes = sorted({len(each.effects) for each in rated})
    return tuple(Level(tuple(each for each in rated if len(each.effects) == size)) for size in sizes)


def _surpassing_limits(rated: Sequence[Rated]) -> list[Rated]:
    """Explanations without those that hardly gain on one with a limit of an effect in its place."""
    accuracies = {frozenset(each.effects): each.accuracy for each in rated}

    def hardly(each: Rated) -> bool:
        effects = frozenset(each.effects)
        simpler = (effects - {name} | {limit} for name in effects for limit in EFFECTS[name].limits)
        return any(accuracies.get(one, inf) < verdict.CLEAR * each.accuracy for one in simpler)

    return [each for each in rated if not hardly(each)]


def ladder(
    search: Search, base: Explanation, explanations: Sequence[Explanation], predict: Predictor
) -> tuple[Level, ...]:
    """Rate the base model and every eligible explanation, and refine the leading ones.

    The best one of each level also predicts tests that are left out of its fit.
    """
    rough = rough_ladder(search, base, explanations)
    return tuple(level_of(search, level.rated, predict) for level in rough)


def rated_where_it_ended(each: Explanation) -> Rated:
    """An explanation with the accuracy of its fit as it is."""
    fit = each.fit
    return Rated(each, accuracy.of_response(fit.model.data, fit.evaluation, fit.dof), fit)


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
