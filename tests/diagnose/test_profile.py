"""Intervals by the rise of Q where its curvature at the end of a fit would make them too narrow."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import chdtri

from tests.diagnose.drawn import LAG, drawn, searched
from wedgesweep.diagnose.profile import profiled
from wedgesweep.diagnose.refine import exact, refine


def serial(function, items):
    return [function(item) for item in items]


def std(fit):
    return np.sqrt(np.diag(fit.covariance))


@pytest.fixture(scope="module")
def lag():
    _, _, (single,) = searched(drawn(LAG), "velocity_lag")
    return exact(single.fit)


def test_where_q_is_a_parabola_its_curvature_tells_the_interval(lag):
    assert std(profiled(lag, serial)) == pytest.approx(std(lag), rel=0.05)


def test_what_seems_more_certain_than_it_is_becomes_as_wide_as_q_says(lag):
    """As derivatives across a jump make it."""
    certain = replace(lag, covariance=lag.covariance / 50.0**2)
    assert std(profiled(certain, serial)) == pytest.approx(std(lag), rel=0.2)


def test_an_interval_is_no_narrower_than_by_the_curvature(lag):
    wide = replace(lag, covariance=9.0 * lag.covariance)
    np.testing.assert_array_equal(std(profiled(wide, serial)), std(wide))


def test_a_fit_that_stopped_short_goes_on_to_the_least_q(lag):
    """By the least of the rises that are looked at, as where a ridge lies in between."""
    point = lag.trial.point
    x = point.x.copy()
    x[0] += 4.0 * std(lag)[0]
    there = lag.model.trial(replace(point, x=x))
    short = replace(refine(lag.model, there, 0), covariance=lag.covariance)
    assert short.q > lag.q + 10.0
    found = profiled(short, serial)
    assert found.q == pytest.approx(lag.q, abs=0.1)
    assert found.x[0] == pytest.approx(lag.x[0], abs=0.1 * std(lag)[0])


def test_the_ends_of_an_interval_are_where_q_has_risen_by_its_share(lag):
    """Of two numbers that do much the same: the other one is fitted again at each end."""
    truth = {"stribeck": {"peak": 0.03, "velocity": 7e-3}}
    _, _, (single,) = searched(drawn(truth, law="coulomb"), "stribeck")
    fit = profiled(exact(single.fit), serial)
    for number in range(2):
        for side in (-1.0, 1.0):
            end = fit.x[number] + side * 1.96 * std(fit)[number]
            model = fit.model.holding(number, np.clip(end, fit.model.low[number], fit.model.high[number]))
            x = fit.x.copy()
            x[number] = model.low[number]
            held = refine(model, model.trial(replace(fit.trial.point, x=x)))
            assert held.q - fit.q > 0.75 * chdtri(1, 0.05)


def test_a_number_at_its_bound_keeps_its_interval(lag):
    """Clean data: the lag is close to zero, and less than zero it cannot be."""
    _, _, (single,) = searched(drawn(), "velocity_lag")
    fit = exact(single.fit)
    found = profiled(fit, serial)
    assert np.isfinite(std(found)).all()
    assert (std(found) >= std(fit)).all()


def test_what_has_no_steady_response_has_no_profile(lag):
    lost = replace(lag, trial=replace(lag.trial, found_tests=np.zeros(lag.model.problem.tests, bool)))
    np.testing.assert_array_equal(std(profiled(lost, serial)), std(lost))
