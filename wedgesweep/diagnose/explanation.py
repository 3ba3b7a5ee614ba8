"""What makes a fit an explanation: what its parameters cost, and least p-values."""

from collections.abc import Callable, Iterable
from math import log
from operator import attrgetter
from typing import TYPE_CHECKING

from wedgesweep.diagnose.fit_data import FitData

if TYPE_CHECKING:
    from wedgesweep.diagnose.model import Fit

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


# Key by which explanations are ranked.
penalised: Callable[["Fit"], float] = attrgetter("penalised")


def best_of_each(found: Iterable["Fit"], misfit: Callable[["Fit"], float]) -> "list[Fit]":
    """The best fit of each set of effects, the best first."""
    best: dict[frozenset[str], Fit] = {}
    for each in sorted(found, key=misfit):
        best.setdefault(frozenset(each.effects), each)
    return list(best.values())
