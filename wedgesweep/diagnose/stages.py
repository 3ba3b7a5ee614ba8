"""The search for an explanation as a list of named stages, in their order.

Each says when it is taken, tells what it changed (``Search.tried``), and can be left out by its name.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.beyond_range import followed_beyond
from wedgesweep.diagnose.explanation import NOTABLE, penalised
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.least_squares import BRIEF, minimise
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.pairs import fit_pairs, simpler
from wedgesweep.diagnose.search import (
    LEADING,
    PAIRS_SHARE,
    Explained,
    Search,
    base_fit,
    refit_base,
    single_fits,
)
from wedgesweep.diagnose.second_effect import adequate_alone, with_either_first, with_second_effect


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
    better = refit_base(known)
    if better.base.chi2 >= NOTABLE * known.base.chi2:
        return better
    return single_fits(better).joined(known.explanations)


def _pairs(known: Explained) -> Explained:
    search, base, found, scans = known
    search.budget.grant(PAIRS_SHARE * search.budget.total)
    return known.joined(fit_pairs(search, base, found, scans))


def _simpler(known: Explained) -> Explained:
    return known.joined(simpler(known.search, known.explanations[0]))


def _with_renewed_covariance(explained: Explained) -> Explained:
    """All fits compared again under the covariance of the best explanation; the leading ones are refitted.

    The noise of a recorded input reaches the comparison through the response. Near a resonance the base model
    may pass on much more, or much less, of it than the right model does. All explanations share one
    covariance, as only then are their misfits on one scale.
    """
    search, base, found, scans = explained
    best = min([base, *found], key=penalised)
    data = search.data.renewed(best.model.scenario(best.point))
    if data is search.data:
        return explained
    search = replace(search, data=data)
    found = sorted((_compared_again(data, each) for each in found), key=penalised)
    base, *leading = search.each(_refitted, [_compared_again(data, base), *found[:LEADING]])
    found = sorted([*leading, *found[LEADING:]], key=penalised)
    scans = {effect: [data.compared_again(each) for each in scan] for effect, scan in scans.items()}
    return Explained(search, base, found, scans)


def _compared_again(data: FitData, fit: Fit) -> Fit:
    return replace(fit, model=fit.model.on(data), evaluation=data.compared_again(fit.evaluation))


def _refitted(fit: Fit) -> Fit:
    return minimise(fit.model, fit.evaluation, BRIEF)


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
    Stage("beyond range", followed_beyond, _inadequate),
    Stage("best pairs", _pairs, _for_pairs),
    Stage("second effect", with_second_effect, adequate_alone),
    Stage("either first", with_either_first, lambda known: _pair_leads(known) and _inadequate(known)),
    Stage("simpler", _simpler, _pair_leads),
    Stage("base model at last", refit_base),
    Stage("covariance renewed again", _with_renewed_covariance),
)
