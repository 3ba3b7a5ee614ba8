"""Fits of problems whose truth is known: chi-squared, intervals, and what each unknown takes up."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.synthetic import AMPLITUDES, LAG, MODEL, drawn, searched
from wedgesweep.diagnose.least_squares import _covariance, minimise, tight_refit


def test_clean_data_leave_chi_squared():
    excess = []
    for seed in range(12):
        _, base, _ = searched(drawn(seed=seed))
        excess.append((base.fit.chi2 - base.fit.dof) / np.sqrt(2.0 * base.fit.dof))
    assert np.mean(excess) == pytest.approx(0.0, abs=3.0 / np.sqrt(12))
    assert max(np.abs(excess)) < 4.0


@pytest.mark.acceptance
def test_intervals_cover_the_truth():
    pulls = []
    for seed in range(15):
        _, _, (lag,) = searched(drawn(LAG, seed), "velocity_lag")
        pulls.append((lag.fit.x[0] - 3e-4) / np.sqrt(lag.fit.covariance[0, 0]))
    assert 0.5 < np.std(pulls) < 1.6
    assert abs(np.mean(pulls)) < 1.0


@pytest.mark.acceptance
def test_the_error_of_a_simulation_is_no_information():
    """A stiff end stop that two tests touch: amplitude, clearance and stiffness are hard to tell apart."""
    truth = {"end_stop": {"clearance": 3.5e-4, "stiffness": 2e5}}
    data = drawn(truth, std=0.015, uncertain={"friction_level": 0.09})
    spectra = tuple(
        replace(s, mean=s.mean[:1], variance=s.variance[:1], level=s.level[:1]) for s in data.spectra
    )
    _, _, (stop,) = searched(replace(data, spectra=spectra), "end_stop")
    fine = tight_refit(stop.fit)
    coarse, std = (np.sqrt(np.diag(fit.covariance)) for fit in (stop.fit, fine))
    np.testing.assert_allclose(coarse, std, rtol=0.1)
    assert fine.chi2 == pytest.approx(stop.fit.chi2, abs=0.1)


@pytest.mark.parametrize("seed", range(2))
def test_a_fit_follows_the_valley_in_which_amplitudes_imitate_a_parameter(seed):
    """Near breakaway a test tells little else than a combination of its amplitude and the preload."""
    std = 0.004
    data = drawn(
        {"preload": {"force": 0.08}},
        seed,
        level=0.025,
        std=std,
        off=std * np.random.default_rng(seed).normal(size=5),
        bench=(np.array([5.0, 8.0, 8.0, 11.0, 19.0]), 1e-3 * np.array([2.5, 0.9, 1.3, 0.55, 0.17])),
        law="coulomb",
        model=MODEL + "[suspension]\ncolumn_angle_deg = -4.0\n",
    )
    _, _, (found,) = searched(data, "preload")
    at_truth = found.fit.model.holding(0, 0.08)
    start = at_truth.evaluate(replace(found.fit.point, x=np.array([0.08])))
    assert found.fit.chi2 < minimise(at_truth, start).chi2 + 0.1
    assert found.fit.x[0] == pytest.approx(0.08, abs=0.002)


def test_what_the_equations_leave_open_is_wide():
    """A number without any trace, and two that do the same."""
    covariance = _covariance(np.array([[4.0, 0.0, 0.0], [0.0, 9.0, 9.0], [0.0, 9.0, 9.0]]))
    assert covariance[0, 0] == pytest.approx(0.25)
    assert covariance[1, 1] > 1e6
    assert _covariance(np.diag([4.0, 0.0]))[1, 1] > 1e6


def test_amplitudes_within_their_prior_are_taken_up():
    _, base, _ = searched(drawn(std=0.02, off=0.02))
    assert base.fit.p > 1e-3
    np.testing.assert_allclose(base.fit.model.data.amplitudes(base.fit.point), 1.02 * AMPLITUDES, rtol=0.01)


def test_unknown_amplitudes_are_found():
    _, base, _ = searched(drawn(known=False))
    assert base.fit.p > 1e-3
    np.testing.assert_allclose(base.fit.model.data.amplitudes(base.fit.point), AMPLITUDES, rtol=0.02)


def test_an_uncertain_number_is_no_cause_within_its_spread():
    truth = {"friction_level": {"scale": 1.06}}
    _, base, _ = searched(drawn(truth, uncertain={"friction_level": 0.05}))
    assert base.fit.p > 1e-3
    assert base.fit.x[0] == pytest.approx(1.06, abs=0.01)
