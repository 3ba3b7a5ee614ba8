"""Intervals by the rise of chi-squared where its curvature would make them too narrow."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.diagnose.synthetic import drawn, lagging, searched
from wedgesweep.diagnose import profile_likelihood as profile
from wedgesweep.diagnose.least_squares import minimise, tight_refit
from wedgesweep.diagnose.model import Model
from wedgesweep.diagnose.profile_likelihood import RISE, profile_likelihood


def serial(function, items):
    return [function(item) for item in items]


def std(fit):
    return np.sqrt(np.diag(fit.covariance))


@pytest.fixture(scope="module")
def lag():
    *_, single = lagging()
    return tight_refit(single)


def test_an_interval_widens_to_the_rise_of_chi2_and_is_no_narrower_than_by_the_curvature(lag):
    assert std(profile_likelihood(lag, serial)) == pytest.approx(std(lag), rel=0.05)
    # As derivatives across a jump make it.
    certain = replace(lag, covariance=lag.covariance / 50.0**2)
    assert std(profile_likelihood(certain, serial)) == pytest.approx(std(lag), rel=0.2)
    wide = replace(lag, covariance=9.0 * lag.covariance)
    np.testing.assert_array_equal(std(profile_likelihood(wide, serial)), std(wide))
    # What has no steady response has no profile.
    lost = replace(lag, evaluation=replace(lag.evaluation, found_tests=np.zeros(lag.model.data.tests, bool)))
    np.testing.assert_array_equal(std(profile_likelihood(lost, serial)), std(lost))


def test_a_fit_that_stopped_short_continues_to_the_minimum(lag):
    """By the least of the rises that are looked at, as where a ridge lies in between."""
    point = lag.evaluation.point
    x = point.x.copy()
    x[0] += 4.0 * std(lag)[0]
    there = lag.model.evaluate(replace(point, x=x))
    short = replace(minimise(lag.model, there, 0), covariance=lag.covariance)
    assert short.chi2 > lag.chi2 + 10.0
    found = profile_likelihood(short, serial)
    assert found.chi2 == pytest.approx(lag.chi2, abs=0.1)
    assert found.x[0] == pytest.approx(lag.x[0], abs=0.1 * std(lag)[0])


def rises(fit):
    """Rise of chi-squared at both ends of the interval of a fit's only number."""
    off = np.sqrt(RISE) * std(fit)[0]
    models = [fit.model.holding(0, fit.x[0] + side * off) for side in (-1.0, 1.0)]
    points = [replace(fit.evaluation.point, x=np.r_[each.low[0], fit.x[1:]]) for each in models]
    return [minimise(m, m.evaluate(p)).chi2 - fit.chi2 for m, p in zip(models, points, strict=True)]


def compliance(level):
    """Fit of columns so stiff that they hardly show, before and after."""
    _, _, (single,) = searched(
        drawn({"column_compliance": {"stiffness": 1e6}}, level=level), "column_compliance"
    )
    fit = tight_refit(single)
    return fit, profile_likelihood(fit, serial)


@pytest.mark.acceptance
def test_the_flatter_side_of_chi2_counts():
    before, fit = compliance(0.1)
    assert max(rises(before)) > 1.2 * min(rises(before))
    assert min(rises(fit)) > 0.9 * RISE


@pytest.mark.acceptance
def test_rugged_chi2_widens_the_interval():
    before, fit = compliance(0.3)
    assert max(rises(before)) < RISE / 2.0
    assert min(rises(fit)) > RISE / 2.0


def test_no_number_is_tried_beyond_its_bound(monkeypatch):
    """Clean data: the lag is zero or next to it, and less than zero it cannot be."""
    _, _, (single,) = searched(drawn(), "velocity_lag")
    fit = tight_refit(single)
    assert fit.x[0] < 1.9 * std(fit)[0]
    tried, holding = [], Model.holding

    def noted(model, number, value):
        tried.append(value)
        return holding(model, number, value)

    monkeypatch.setattr(Model, "holding", noted)
    found = profile_likelihood(fit, serial)
    assert min(tried) == 0.0 < max(tried)
    assert np.isfinite(std(found)).all()
    assert (std(found) >= std(fit)).all()


def end_of_a_switch(monkeypatch, std, rise, value=0.1):
    """Upper end of the interval of a number in 0 to 1, by the rise of chi-squared, and what was tried."""
    tried = []

    def held(side, off, start):
        tried.append(value + off * std)
        return SimpleNamespace(chi2=side.fit.chi2 + rise(tried[-1]))

    monkeypatch.setattr(profile._Side, "held", held)
    hypothesis = SimpleNamespace(parameters=[SimpleNamespace(switches=True)])
    model = SimpleNamespace(low=np.zeros(1), high=np.ones(1), hypothesis=hypothesis)
    fit = SimpleNamespace(x=np.array([value]), covariance=np.array([[std**2]]), model=model, chi2=50.0)
    side = profile._Side(fit, 0, 1.0)
    found = profile._profile_end(side, side.nearest)
    return value + found.end * std, tried


def test_an_interval_contains_ridges_behind_which_the_fit_is_nearly_as_good(monkeypatch):
    end, tried = end_of_a_switch(monkeypatch, 0.01, lambda x: 1.0 if 0.2 < x < 0.3 else 3.0 * RISE)
    assert 0.3 < end < 0.6
    assert max(tried) == pytest.approx(1.0)
    # Nothing is tried far beyond it.
    end, tried = end_of_a_switch(monkeypatch, 0.01, lambda x: RISE * (x / 0.11) ** 8)
    assert end == pytest.approx(0.1196, abs=1e-3)
    assert len(tried) == 3
