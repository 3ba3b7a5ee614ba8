"""The accuracy ladder: how well the tests are explained by no effect, by one, and by two."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf

from wedgesweep.diagnose import accuracy, cross_validation, verdict
from wedgesweep.diagnose.explanation import Explanation
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.search import Search

# The most accurate explanations of each size are fitted again at their accuracy: so many at most, and only
# those within this factor of the best.
REFINED, FACTOR = 6, 3.0
# Explanations of a size whose accuracies are compared.
COMPARED = 2


@dataclass(frozen=True, eq=False)
class Rated:
    """An explanation with its accuracy; ``inf`` where it is adequate at none.

    ``fit``: at that accuracy. ``held_out``: accuracy of its predictions of tests that were left out of the
    fit, None where there are none or it was not asked for.
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


def ladder(search: Search, base: Explanation, explanations: Sequence[Explanation]) -> tuple[Level, ...]:
    """Rate the base model and every explanation; a level for each number of effects that was tried.

    The best of each size also predict tests that are left out of their fit.
    """
    allowed = [base, *filter(verdict.eligible, explanations)]
    rough = search.each(_rough, allowed)
    sizes = sorted({len(each.effects) for each in rough})
    return tuple(_level(search, [each for each in rough if len(each.effects) == size]) for size in sizes)


def _rough(each: Explanation) -> Rated:
    fit = each.fit
    return Rated(each, accuracy.of_response(fit.model.data, fit.evaluation, fit.dof), fit)


def _level(search: Search, rough: Sequence[Rated]) -> Level:
    """The explanations of one size; the leading ones, and all that would lead, are refined."""
    waiting, done = sorted(rough, key=_order), list[Rated]()
    chosen = [each for each in waiting[:REFINED] if each.accuracy <= FACTOR * waiting[0].accuracy]
    while chosen:
        done = sorted([*done, *search.each(_refined, chosen)], key=_order)
        waiting = waiting[len(chosen) :]
        chosen = _leading(waiting, done)
    order = sorted([*done, *waiting], key=_order)
    return Level((_tested(search, order[0]), *order[1:]))


def _leading(waiting: list[Rated], done: list[Rated]) -> list[Rated]:
    """Of explanations that wait to be refined, best first, those that would be among the leading ones."""
    if len(done) < COMPARED:
        return waiting[: COMPARED - len(done)]
    last = _order(done[COMPARED - 1])
    return [each for each in waiting[:REFINED] if _order(each) < last]


def _tested(search: Search, best: Rated) -> Rated:
    if best.accuracy == inf:
        return best
    return replace(best, held_out=cross_validation.held_out_accuracy(best.fit, search.each))


def _refined(each: Rated) -> Rated:
    found = accuracy.refined(each.fit)
    return replace(each, accuracy=found.size, fit=found.fit)


def _order(each: Rated) -> tuple[float, float]:
    return each.accuracy, each.explanation.penalised
