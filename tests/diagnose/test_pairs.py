"""Pairs are found even where their effects do not show alone."""

from types import SimpleNamespace

import numpy as np
import pytest

from tests.diagnose.synthetic import drawn, next_to_breakaway
from wedgesweep.diagnose import pairs
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.search import Search, base_fit, single_fit, single_fits

# More preload and less friction: alone, neither explains as much as another mass.
TRUTH = {"preload": {"force": 0.3}, "friction_level": {"scale": 0.85}}
CANDIDATES = (*TRUTH, "bolster_mass")


def test_pairs_are_found_whose_effects_do_not_lead_alone():
    search, base, singles, scans = single_fits(base_fit(Search.of(drawn(TRUTH), CANDIDATES)))
    assert min(singles, key=lambda each: each.fit.chi2).effects == ("bolster_mass",)
    best = pairs.fit_pairs(search, base.fit, singles, scans)[0]
    assert set(best.effects) == set(TRUTH)
    assert best.fit.p > 1e-3


@pytest.mark.acceptance
def test_where_responses_do_not_add_the_second_effect_begins_with_nothing():
    """By every start of the damper that was tried a test sticks."""
    search, base, *_ = base_fit(Search.of(next_to_breakaway(), ("stribeck", "viscous_damping")))
    damper, stribecks = (single_fit(search, effect, base.fit) for effect in ("viscous_damping", "stribeck"))
    model = search.model("stribeck")
    stribeck = minimise(model, model.evaluate(model.start(base.fit, np.array([6e-3, -0.43]))), 3)
    first = pairs.single_scan(base.fit, stribeck, stribecks.scan)
    second = pairs.single_scan(base.fit, damper.explanation.fit, damper.scan)
    begun = pairs.starting_fit(search, pairs.Combination(first, second))
    assert begun.chi2 < pairs.BEHIND * first.subset.chi2


def fits(*misfits, p):
    """Stand-ins of fits to several pairs; ``p``: probability of the best one's misfit."""
    return [
        SimpleNamespace(chi2=q, p=p if q == min(misfits) else 0.0, effects=(str(i), "other"))
        for i, q in enumerate(misfits)
    ]


def test_only_what_is_far_behind_a_pair_that_will_do_is_given_up():
    far = 2.0 * pairs.BEHIND * 100.0
    near = 0.9 * pairs.BEHIND * 100.0
    several = fits(far, 100.0, *[near] * pairs.SEVERAL, far, p=0.5)
    assert [fit.chi2 for fit in pairs.promising(several)] == [100.0, *[near] * pairs.SEVERAL]
    assert len(pairs.promising(fits(100.0, *[far] * 9, p=0.5))) == pairs.SEVERAL
    assert len(pairs.promising(fits(100.0, *[far] * 9, p=1e-6))) == 10
