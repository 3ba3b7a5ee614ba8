"""The search for an explanation as a list of named stages, in their order.

Each says when it is taken, tells what it changed (``Search.tried``), and can be left out by its name.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.beyond_range import followed_beyond
from wedgesweep.diagnose.explanation import Explanation, best_of_each, penalised
from wedgesweep.diagnose.least_squares import BRIEF, minimise
from wedgesweep.diagnose.pairs import components, fit_pairs
from wedgesweep.diagnose.search import (
    NOTABLE,
    PAIRS_SHARE,
    Explained,
    Search,
    base_fit,
    contenders,
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
    return taken((*REFINEMENT, *PAIRS), single_fits(base_fit(search)))


def taken(stages: Sequence[Stage], known: Explained) -> Explained:
    """What is known after some stages; each may renew the search: its data, and its ranges."""
    for stage in stages:
        if stage.when(known):
            known = known.search.tried(stage.name, known, stage.apply)
    return known


def _base_model_again(known: Explained) -> Explained:
    """The base model from where an extension ended, and single effects beside it if it fits far better."""
    found, better = known.explanations, refit_base(known)
    # An adequate explanation hands its nuisance parameters on to the others, which need no better base then.
    handed_on = known.search.data.shares_nuisances and not verdict.none_adequate(found)
    if better.base.fit.chi2 >= NOTABLE * known.base.fit.chi2 or handed_on:
        return better
    again = single_fits(better)
    return again._replace(explanations=best_of_each([*found, *again.explanations], penalised))


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


def _with_renewed_covariance(explained: Explained) -> Explained:
    """All fits compared again under the covariance of the best explanation; the leading ones are refitted.

    The noise of a recorded input reaches the comparison through the response. Near a resonance the base model
    may pass on much more, or much less, of it than the right model does. All explanations share one
    covariance, as only then are their misfits on one scale.
    """
    search, base, found, scans = explained
    best = min([base, *found], key=penalised).fit
    data = search.data.renewed(best.model.scenario(best.point))
    if data is search.data:
        return explained
    search = replace(search, data=data)
    found = sorted((_compared_again(search, each) for each in found), key=penalised)
    leading = contenders(search, found)
    others = [each for each in found if not any(each is one for one in leading)]
    again = [_compared_again(search, base), *leading]
    base, *leading = search.each(lambda each: _refitted(search, each), again)
    found = sorted([*leading, *others], key=penalised)
    scans = {effect: [data.compared_again(each) for each in scan] for effect, scan in scans.items()}
    return Explained(search, base, found, scans)


def _compared_again(search: Search, each: Explanation) -> Explanation:
    model = each.fit.model.on(search.data)
    evaluation = search.data.compared_again(each.fit.evaluation)
    return search.explanation(replace(each.fit, model=model, evaluation=evaluation))


def _refitted(search: Search, each: Explanation) -> Explanation:
    return search.explanation(minimise(each.fit.model, each.fit.evaluation, BRIEF))


def _inadequate(known: Explained) -> bool:
    """Whether neither the base model nor any explanation is adequate."""
    return verdict.none_adequate([known.base, *known.explanations])


def _for_pairs(known: Explained) -> bool:
    """Whether nothing is adequate, and there are enough tests to search on."""
    return _inadequate(known) and known.search.data.tests >= verdict.FEWEST_TESTS


def _pair_leads(known: Explained) -> bool:
    return bool(known.explanations) and len(known.explanations[0].effects) > 1


REFINEMENT = (
    Stage("base model again", _base_model_again),
    Stage("covariance renewed", _with_renewed_covariance),
)
PAIRS = (
    Stage("best refitted", _found(refit_best), lambda known: verdict.none_adequate([known.base])),
    Stage("beyond range", _beyond_range, _inadequate),
    Stage("best pairs", _explanations(_pairs), _for_pairs),
    Stage("components", _found(components), _pair_leads),
    Stage("base model at last", refit_base),
    Stage("covariance renewed again", _with_renewed_covariance),
)
