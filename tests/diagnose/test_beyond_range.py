"""Numbers that lie outside of the range in which they are searched."""

from math import inf, log

import numpy as np
import pytest

from tests.diagnose.synthetic import drawn
from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.beyond_range import effects_at_range_end, followed_beyond
from wedgesweep.diagnose.explanation import Explanation
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.result.estimates import parameters
from wedgesweep.diagnose.search import Explained, Search, base_fit
from wedgesweep.diagnose.stages import explain
from wedgesweep.effects import EFFECTS
from wedgesweep.natural_units import BENCH

QUANTITIES = [(name, q) for name, effect in EFFECTS.items() for q in effect.quantities if q.search]
ALL = pytest.mark.parametrize(("name", "quantity"), QUANTITIES, ids=lambda one: getattr(one, "key", one))


@ALL
def test_the_wider_range_holds_the_searched_one_and_only_valid_numbers(name, quantity):
    (low, high), (lowest, highest) = quantity.search, quantity.wider()
    assert lowest <= low < high <= highest
    assert quantity.fault(lowest) is None
    assert quantity.fault(highest) is None
    if quantity.logarithmic:
        assert 0.0 < lowest < low
    assert np.isfinite([lowest, highest]).all()


@pytest.mark.parametrize("name", EFFECTS)
def test_only_named_effects_leave_their_range(name):
    plain, wider = Hypothesis((name,)), Hypothesis((name,), (), BENCH, (name,))
    assert Hypothesis((name,), (), BENCH, ("other",)).low.tolist() == plain.low.tolist()
    assert (wider.scale == plain.scale).all()
    for each, low, high in zip(wider.parameters, wider.low, wider.high, strict=True):
        assert (low, high) == ((-inf, inf) if each.angle else each.wider)


def friction_of(scale):
    """Data of a bench with this share of the friction of its model."""
    return drawn({"friction_level": {"scale": scale}}, 3, 0.02, std=0.001)


@pytest.mark.few(1)
@pytest.mark.parametrize("scale", [0.3, 2.6])
def test_a_cause_beyond_the_range_is_named(scale):
    assert not 0.5 <= scale <= 2.0
    search, base, found, _ = explain(Search.of(friction_of(scale), ("friction_level", "viscous_damping")))
    assert "friction_level" in search.wider
    finding = verdict.decide(base, found, verdict.thresholds_for(search.data))
    assert (finding.verdict, finding.best.effects) == (verdict.NAMED, ("friction_level",))
    told = parameters(finding.best.fit)["friction_level"]["scale"]
    assert told["ci95"][0] < scale < told["ci95"][1]
    assert told["searched"] == [0.5, 2.0]


@pytest.mark.acceptance
def test_a_number_inside_of_its_range_is_told_without_it():
    search, _, found, _ = explain(Search.of(friction_of(1.5), ("friction_level", "viscous_damping")))
    assert search.wider == ()
    assert "searched" not in parameters(found[0].fit)["friction_level"]["scale"]


def test_a_number_at_an_end_of_what_is_possible_is_not_followed():
    """Nothing is beyond no friction."""
    search = Search.of(friction_of(1.0), ("guide_friction",))
    model = search.model("guide_friction")
    fit = minimise(model, model.evaluate(model.start(None, np.array([0.0]))), 0)
    assert effects_at_range_end(fit) == ()
    known = followed_beyond(Explained(search, Explanation(fit), [Explanation(fit)], {}))
    assert known.search.wider == ()
    assert [each.fit for each in known.explanations] == [fit]


def test_an_effect_that_explains_next_to_nothing_is_not_followed():
    """Where it is absent, as an ever stiffer column, its simulations take longest."""
    search = Search.of(friction_of(2.6), ("friction_level",))
    _, base, *_ = base_fit(search)
    model = search.model("friction_level")
    fit = minimise(model, model.evaluate(model.start(base.fit, np.array([2.0]))))
    assert effects_at_range_end(fit) == ("friction_level",)
    assert fit.chi2 < 0.9 * base.fit.chi2
    explanation = Explanation(fit)
    for worse, wider in ((base, ("friction_level",)), (explanation, ())):
        assert followed_beyond(Explained(search, worse, [explanation], {})).search.wider == wider


def test_a_logarithm_ends_at_either_end_of_its_range():
    search = Search.of(friction_of(1.0), ("column_compliance",))
    model = search.model("column_compliance")
    low, high = EFFECTS["column_compliance"].quantities[0].search
    for value, ends in ((low, True), (high, True), (0.5 * high, False)):
        x = np.array([log(value), *(0.5 * (model.low + model.high))[1:]])
        fit = minimise(model, model.evaluate(model.start(None, x)), 0)
        assert (effects_at_range_end(fit) == ("column_compliance",)) is ends
