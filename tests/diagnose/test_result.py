"""Intervals of fitted numbers: in the coordinate of the fit, and never beyond the range that was searched."""

from math import exp, log

import pytest

from wedgesweep.diagnose.result.estimates import change, interval, widen
from wedgesweep.effects import EFFECTS

QUANTITIES = [(name, q) for name, effect in EFFECTS.items() for q in effect.quantities if q.search]
ALL = pytest.mark.parametrize(("name", "quantity"), QUANTITIES, ids=lambda one: getattr(one, "key", one))


@ALL
def test_a_number_that_the_data_leave_open_has_the_searched_range(name, quantity):
    low, high = quantity.search
    ends = interval(quantity, low + 0.3 * (high - low), 1e6, quantity.search)
    assert ends[1] - ends[0] == pytest.approx(high - low)


@ALL
def test_a_narrow_interval_is_symmetric_in_the_coordinate_of_the_fit(name, quantity):
    low, high = quantity.search
    value = low + 0.5 * (high - low)
    below, above = (change(quantity, value, end) for end in interval(quantity, value, 1e-3, quantity.search))
    assert above == pytest.approx(-below)
    assert above == pytest.approx(1e-3)


def test_a_logarithm_and_an_angle():
    stiffness = dict(QUANTITIES)["column_compliance"]
    assert interval(stiffness, 60.0, log(2.0), stiffness.search) == pytest.approx((30.0, 120.0))
    assert change(stiffness, 60.0, 60.0 * exp(0.1)) == pytest.approx(0.1)
    angle = next(q for _, q in QUANTITIES if q.angle)
    assert change(angle, 179.0, -179.0) == pytest.approx(2.0)


def test_the_interval_of_a_cause_holds_those_that_other_explanations_find():
    own, others = {"preload": {"force_N": {"value": 2.0, "ci95": [1.9, 2.1]}}}, {"stribeck": {}}
    for low, high in (1.7, 1.8), (2.0, 2.3):
        widen(own, others | {"preload": {"force_N": {"value": low, "ci95": [low, high]}}})
    assert own["preload"]["force_N"] == {"value": 2.0, "ci95": [1.7, 2.3]}
