"""Explanations: fits of hypotheses with what their parameters cost."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from math import log
from operator import attrgetter
from typing import TypeVar

from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.parameter_constancy import Constancy, parameter_constancy

# Each parameter costs ln n + PENALTY in chi-squared, n being the number of observations. PENALTY is such that
# clean data keep the base model though the best of some twenty candidates is compared with it.
PENALTY = 6.0
# A model explains notably more than another if it leaves less than this share of the other's chi-squared, or
# of its error on tests left out: a smaller gain is no reason to prefer one with more numbers.
NOTABLE = 0.9
# Least p-values: of an adequate model, of one that is possible at all, and of a base model from which nothing
# need be missing. One clean set in ten thousand is below the last.
ADEQUATE, POSSIBLE, TOLERABLE = 0.01, 1e-3, 1e-4


def parameter_penalty(data: FitData) -> float:
    """Chi-squared that one more parameter of a hypothesis costs."""
    return log(data.observations.sum()) + PENALTY


@dataclass(frozen=True)
class Explanation:
    """A fit of a hypothesis, with what its parameters cost."""

    fit: Fit

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

        The latter takes simulations, and is left out where the misfit alone rules the explanation out.
        """
        return min(self.fit.p, self.constancy.p) if self.fit.p >= POSSIBLE else self.fit.p

    @property
    def penalised(self) -> float:
        """Chi-squared plus the penalty for all parameters."""
        return self.fit.chi2 + parameter_penalty(self.fit.model.data) * self.fit.model.size


# Key by which explanations are ranked.
penalised: Callable[[Explanation], float] = attrgetter("penalised")
Each = TypeVar("Each", Fit, Explanation)


def best_of_each(found: Iterable[Each], misfit: Callable[[Each], float]) -> list[Each]:
    """The best fit or explanation of each set of effects, the best first."""
    best: dict[frozenset[str], Each] = {}
    for each in sorted(found, key=misfit):
        best.setdefault(frozenset(each.effects), each)
    return list(best.values())
