"""The search for an explanation as a list of named stages, in their order.

Each says when it is taken, tells what it changed (``Search.tried``), and can be left out by its name.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.beyond_range import followed_beyond
from wedgesweep.diagnose.explanation import Explanation, best_of_each, penalised
from wedgesweep.diagnose.pairs import components, fit_pairs
from wedgesweep.diagnose.renewal import with_renewed_covariance
from wedgesweep.diagnose.search import (
    NOTABLE,
    PAIRS_SHARE,
    Explained,
    Search,
    base_fit,
    followed,
    from_shared_nuisances,
    from_special_cases,
    refit_base,
    refit_best,
    single_fits,
)


class Stage(NamedTuple):
    """A stage of the search: what it makes of what is known, and when it is taken."""

    name: str
    apply: Callable[[Explained], Explained]
    when: Callable[[Explained], bool] = lambda known: True


def explain(search: Search) -> Explained:
    """Fit the base model, every candidate, and pairs of candidates where no single one is adequate."""
    return taken((*REFINEMENT, *PAIRS), single_effects(base_model(search)))


def taken(stages: Sequence[Stage], known: Explained) -> Explained:
    """What is known after some stages; each may renew the search: its data, and its ranges."""
    for stage in stages:
        if stage.when(known):
            known = known.search.tried(stage.name, known, stage.apply)
    return known


def base_model(search: Search) -> Explained:
    """The fit of the base model."""
    search.progress("base model")
    search, base = base_fit(search)
    return Explained(search, base, [], {})


def single_effects(known: Explained) -> Explained:
    """The fit of every candidate effect by itself."""
    search, found, scans = single_fits(known.search, known.base.fit)
    return Explained(search, known.base, found, scans)


def _base_model_again(known: Explained) -> Explained:
    """The base model from where an extension ended, and single effects beside it if it fits far better."""
    search, base, found, scans = known
    search, better = refit_base(search, base, found)
    # An adequate explanation hands its nuisance parameters on to the others, which need no better base then.
    handed_on = search.data.shares_nuisances and not verdict.none_adequate(found)
    if better.fit.chi2 < NOTABLE * base.fit.chi2 and not handed_on:
        search, again, scans = single_fits(search, better.fit)
        found = best_of_each([*found, *again], penalised)
    return Explained(search, better, found, scans)


def _base_model_at_last(known: Explained) -> Explained:
    search, base = refit_base(known.search, known.base, known.explanations)
    return known._replace(search=search, base=base)


def _beyond_range(known: Explained) -> Explained:
    search, found = followed_beyond(known.search, known.base, known.explanations)
    return known._replace(search=search, explanations=found)


def _pairs(known: Explained) -> list[Explanation]:
    search, base, found, scans = known
    search.budget.grant(PAIRS_SHARE * search.budget.total)
    return [*found, *fit_pairs(search, base.fit, found, scans)]


def _found(
    function: Callable[[Search, Sequence[Explanation]], list[Explanation]],
) -> Callable[[Explained], Explained]:
    """A stage that changes explanations only."""
    return _explanations(lambda known: function(known.search, known.explanations))


def _explanations(function: Callable[[Explained], list[Explanation]]) -> Callable[[Explained], Explained]:
    return lambda known: known._replace(explanations=best_of_each(function(known), penalised))


def _inadequate(known: Explained) -> bool:
    """Whether neither the base model nor any explanation is adequate."""
    return verdict.none_adequate([known.base, *known.explanations])


def _for_pairs(known: Explained) -> bool:
    """Whether nothing is adequate, and there are enough tests to search on."""
    return _inadequate(known) and known.search.data.tests >= verdict.FEWEST_TESTS


def _pair_leads(known: Explained) -> bool:
    return bool(known.explanations) and len(known.explanations[0].effects) > 1


def _shared_and_inadequate(known: Explained) -> bool:
    return known.search.data.shares_nuisances and verdict.none_adequate(known.explanations)


REFINEMENT = (
    Stage("fits continued", _found(followed), _shared_and_inadequate),
    Stage("base model again", _base_model_again),
    Stage("special cases", _found(from_special_cases)),
    Stage("starts shared", _found(from_shared_nuisances)),
    Stage("covariance renewed", with_renewed_covariance),
)
PAIRS = (
    Stage("best refitted", _found(refit_best), lambda known: verdict.none_adequate([known.base])),
    Stage("beyond range", _beyond_range, _inadequate),
    Stage("best pairs", _explanations(_pairs), _for_pairs),
    Stage("components", _found(components), _pair_leads),
    Stage("best refitted again", _found(refit_best), _shared_and_inadequate),
    Stage("starts shared again", _found(from_shared_nuisances)),
    Stage("base model at last", _base_model_at_last),
    Stage("covariance renewed again", with_renewed_covariance),
)
