"""Fits of problems whose truth is known: chi-squared, intervals, and what each unknown takes up."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.synthetic import AMPLITUDES, LAG, MODEL, base_of, drawn, searched
from wedgesweep.diagnose.least_squares import _covariance, minimise, tight_refit
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.rest import breakaway_accelerations


def test_clean_data_leave_chi_squared():
    excess = []
    for seed in range(12):
        _, base, _ = searched(drawn(seed=seed))
        excess.append((base.chi2 - base.dof) / np.sqrt(2.0 * base.dof))
    assert np.mean(excess) == pytest.approx(0.0, abs=3.0 / np.sqrt(12))
    assert max(np.abs(excess)) < 4.0


@pytest.mark.acceptance
def test_intervals_cover_the_truth():
    pulls = []
    for seed in range(15):
        _, _, (lag,) = searched(drawn(LAG, seed), "velocity_lag")
        pulls.append((lag.x[0] - 3e-4) / np.sqrt(lag.covariance[0, 0]))
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
    fine = tight_refit(stop)
    coarse, std = (np.sqrt(np.diag(fit.covariance)) for fit in (stop, fine))
    np.testing.assert_allclose(coarse, std, rtol=0.1)
    assert fine.chi2 == pytest.approx(stop.chi2, abs=0.1)


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
    at_truth = found.model.holding(0, 0.08)
    start = at_truth.evaluate(replace(found.point, x=np.array([0.08])))
    assert found.chi2 < minimise(at_truth, start).chi2 + 0.1
    assert found.x[0] == pytest.approx(0.08, abs=0.002)


def test_what_the_equations_leave_open_is_wide():
    """A number without any trace, and two that do the same."""
    covariance = _covariance(np.array([[4.0, 0.0, 0.0], [0.0, 9.0, 9.0], [0.0, 9.0, 9.0]]))
    assert covariance[0, 0] == pytest.approx(0.25)
    assert covariance[1, 1] > 1e6
    assert _covariance(np.diag([4.0, 0.0]))[1, 1] > 1e6


def test_amplitudes_and_uncertain_numbers_are_found_within_what_is_known_of_them():
    for known, share, close in (({"std": 0.02, "off": 0.02}, 1.02, 0.01), ({"known": False}, 1.0, 0.02)):
        base = base_of(drawn(**known))
        assert base.p > 1e-3
        found = base.model.data.amplitudes(base.point)
        np.testing.assert_allclose(found, share * AMPLITUDES, rtol=close)
    base = base_of(drawn({"friction_level": {"scale": 1.06}}, uncertain={"friction_level": 0.05}))
    assert base.p > 1e-3
    assert base.x[0] == pytest.approx(1.06, abs=0.01)


FREQUENCIES = np.array([20.0, 30.0, 8.0, 20.0])


@pytest.mark.parametrize("beyond", [1.6, 2.0])
def test_inputs_are_found_near_breakaway(beyond):
    """There the bolster moves by a small part of its input, and a bit less input holds it."""
    held = breakaway_accelerations(parameters.record("coulomb", 1e-4, 100.0))[0][0]
    true = beyond * held / (2.0 * np.pi * FREQUENCIES) ** 2 * np.array([1.0, 1.0, 1.0, 3.0])
    data = drawn(law="coulomb", known=False, bench=(FREQUENCIES, true))
    if beyond < 2.0:
        assert (true > 30.0 * np.abs(data.measured[:, 0, 0])).sum() == 2
    base = base_of(data)
    assert base.p > 1e-3
    assert base.model.data.amplitudes(base.point) == pytest.approx(true, rel=1e-3)
