"""Explanations: fits of hypotheses with what their parameters cost."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.parameter_constancy import Constancy, parameter_constancy

# Each parameter costs ln n + PENALTY in chi-squared: with 21 candidates clean data keep the base model.
PENALTY = 6.0
# Least p-value of an adequate model, and of one that is possible at all.
ADEQUATE, POSSIBLE = 0.01, 1e-3


@dataclass(frozen=True)
class Explanation:
    """A fit of a hypothesis, and the penalty for each of its parameters."""

    fit: Fit
    parameter_penalty: float

    @property
    def effects(self) -> tuple[str, ...]:
        return self.fit.effects

    @cached_property
    def constancy(self) -> Constancy:
        """Whether its parameters are the same in all tests."""
        return parameter_constancy(self.fit)

    @property
    def p_value(self) -> float:
        """The smaller of two p-values: that of the misfit, and that of the test for constant parameters.

        Constancy takes simulations, and is not looked at where the misfit alone rules the explanation out.
        """
        return min(self.fit.p, self.constancy.p) if self.fit.p >= POSSIBLE else self.fit.p

    @property
    def penalised(self) -> float:
        """Chi-squared plus the penalty for all parameters."""
        return self.fit.chi2 + self.parameter_penalty * self.fit.model.size


def penalised(each: Explanation) -> float:
    """Explanations are ranked by this."""
    return each.penalised


Each = TypeVar("Each", Fit, Explanation)


def best_of_each(found: Iterable[Each], misfit: Callable[[Each], float]) -> list[Each]:
    """The best fit or explanation of each set of effects, the best first."""
    best: dict[frozenset[str], Each] = {}
    for each in sorted(found, key=misfit):
        best.setdefault(frozenset(each.effects), each)
    return list(best.values())
