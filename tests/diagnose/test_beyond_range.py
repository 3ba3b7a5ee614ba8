"""Numbers at the ends of the range in which they are searched, and beyond; their intervals."""

from math import exp, inf, log

import numpy as np
import pytest

from tests.diagnose.synthetic import drawn
from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.beyond_range import effects_at_range_end, followed_beyond
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.result.estimates import change, interval, parameters, widen
from wedgesweep.diagnose.search import Explained, Search, base_fit
from wedgesweep.diagnose.stages import explain
from wedgesweep.effects import EFFECTS
from wedgesweep.natural_units import BENCH

QUANTITIES = [(name, q) for name, effect in EFFECTS.items() for q in effect.quantities if q.search]


def test_the_wider_range_holds_the_searched_one_and_only_valid_numbers():
    for name, quantity in QUANTITIES:
        (low, high), (lowest, highest) = quantity.search, quantity.wider()
        assert lowest <= low < high <= highest, name
        assert quantity.fault(lowest) is quantity.fault(highest) is None, name
        if quantity.logarithmic:
            assert 0.0 < lowest < low, name
        assert np.isfinite([lowest, highest]).all(), name
    # Only effects that are named leave their range.
    for name in EFFECTS:
        plain, wider = Hypothesis((name,)), Hypothesis((name,), (), BENCH, (name,))
        assert Hypothesis((name,), (), BENCH, ("other",)).low.tolist() == plain.low.tolist()
        assert (wider.scale == plain.scale).all()
        for each, low, high in zip(wider.parameters, wider.low, wider.high, strict=True):
            assert (low, high) == ((-inf, inf) if each.angle else each.wider)


def test_intervals_are_symmetric_in_the_coordinate_of_the_fit_and_no_wider_than_the_range():
    for name, quantity in QUANTITIES:
        low, high = quantity.search
        ends = interval(quantity, low + 0.3 * (high - low), 1e6, quantity.search)
        assert ends[1] - ends[0] == pytest.approx(high - low), name
        value = low + 0.5 * (high - low)
        ends = interval(quantity, value, 1e-3, quantity.search)
        assert [change(quantity, value, end) for end in ends] == pytest.approx([-1e-3, 1e-3]), name
    stiffness = dict(QUANTITIES)["column_compliance"]
    assert interval(stiffness, 60.0, log(2.0), stiffness.search) == pytest.approx((30.0, 120.0))
    assert change(stiffness, 60.0, 60.0 * exp(0.1)) == pytest.approx(0.1)
    angle = next(q for _, q in QUANTITIES if q.angle)
    assert change(angle, 179.0, -179.0) == pytest.approx(2.0)


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
    told = parameters(finding.best)["friction_level"]["scale"]
    assert told["ci95"][0] < scale < told["ci95"][1]
    assert told["searched"] == [0.5, 2.0]


def test_an_interval_holds_a_number_whose_two_parts_are_at_their_ends():
    """A magnitude with a phase is fitted as two parts, and reaches the corner of their bounds."""
    model = Search.of(friction_of(1.0), ("input_distortion",)).model("input_distortion")
    fit = minimise(model, model.evaluate(model.start(None, model.hypothesis.high)), 0)
    told = parameters(fit)["input_distortion"]["second"]
    assert told["value"] == pytest.approx(2.0**0.5 * told["searched"][1])
    assert told["ci95"][0] < told["value"] <= told["ci95"][1]


@pytest.mark.acceptance
def test_a_number_inside_of_its_range_is_told_without_it():
    search, _, found, _ = explain(Search.of(friction_of(1.5), ("friction_level", "viscous_damping")))
    assert search.wider == ()
    assert "searched" not in parameters(found[0])["friction_level"]["scale"]


def test_a_number_at_an_end_of_what_is_possible_is_not_followed():
    """Nothing is beyond no friction."""
    search = Search.of(friction_of(1.0), ("guide_friction",))
    model = search.model("guide_friction")
    fit = minimise(model, model.evaluate(model.start(None, np.array([0.0]))), 0)
    assert effects_at_range_end(fit) == ()
    known = followed_beyond(Explained(search, fit, [fit], {}))
    assert known.search.wider == ()
    assert known.explanations == [fit]


def test_an_effect_that_explains_next_to_nothing_is_not_followed():
    """Where it is absent, as an ever stiffer column, its simulations take longest."""
    search = Search.of(friction_of(2.6), ("friction_level",))
    _, base, *_ = base_fit(search)
    model = search.model("friction_level")
    fit = minimise(model, model.evaluate(model.start(base, np.array([2.0]))))
    assert effects_at_range_end(fit) == ("friction_level",)
    assert fit.chi2 < 0.9 * base.chi2
    for worse, wider in ((base, ("friction_level",)), (fit, ())):
        assert followed_beyond(Explained(search, worse, [fit], {})).search.wider == wider


def test_a_logarithm_ends_at_either_end_of_its_range():
    search = Search.of(friction_of(1.0), ("column_compliance",))
    model = search.model("column_compliance")
    low, high = EFFECTS["column_compliance"].quantities[0].search
    for value, ends in ((low, True), (high, True), (0.5 * high, False)):
        x = np.array([log(value), *(0.5 * (model.low + model.high))[1:]])
        fit = minimise(model, model.evaluate(model.start(None, x)), 0)
        assert (effects_at_range_end(fit) == ("column_compliance",)) is ends


def test_the_interval_of_a_cause_holds_those_that_other_explanations_find():
    own, others = {"preload": {"force_N": {"value": 2.0, "ci95": [1.9, 2.1]}}}, {"stribeck": {}}
    for low, high in (1.7, 1.8), (2.0, 2.3):
        widen(own, others | {"preload": {"force_N": {"value": low, "ci95": [low, high]}}})
    assert own["preload"]["force_N"] == {"value": 2.0, "ci95": [1.7, 2.3]}
