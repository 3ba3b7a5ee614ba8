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
    order = sorted(rough, key=_order)
    chosen = [each for each in order[:REFINED] if each.accuracy <= FACTOR * order[0].accuracy]
    done: list[Rated] = []
    while chosen:
        done += search.each(_refined, chosen)
        waiting = [each for each in order if all(each.explanation is not one.explanation for one in done)]
        order = sorted([*done, *waiting], key=_order)
        chosen = [each for each in order[:COMPARED] if each in waiting]
    return Level((_tested(search, order[0]), *order[1:]))


def _tested(search: Search, best: Rated) -> Rated:
    if best.accuracy == inf:
        return best
    return replace(best, held_out=cross_validation.held_out_accuracy(best.fit, search.each))


def _refined(each: Rated) -> Rated:
    found = accuracy.refined(each.fit)
    return replace(each, accuracy=found.size, fit=found.fit)


def _order(each: Rated) -> tuple[float, float]:
    return each.accuracy, each.explanation.penalised
