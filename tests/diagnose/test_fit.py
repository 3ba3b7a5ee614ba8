"""Fits of problems whose truth is known: chi-squared, intervals, and what each unknown takes up."""

import numpy as np
import pytest

from tests.diagnose.drawn import AMPLITUDES, drawn
from wedgesweep.diagnose import gain
from wedgesweep.diagnose.search import Search

LAG = {"velocity_lag": {"time": 3e-4}}


def searched(problem, *effects):
    search = Search(problem, effects)
    base = search.base()
    return search, base, [search.single(effect, base.fit) for effect in effects]


def test_clean_data_leave_chi_squared():
    excess = []
    for seed in range(12):
        _, base, _ = searched(drawn(seed=seed))
        excess.append((base.fit.q - base.fit.dof) / np.sqrt(2.0 * base.fit.dof))
    assert np.mean(excess) == pytest.approx(0.0, abs=3.0 / np.sqrt(12))
    assert max(np.abs(excess)) < 4.0


def test_a_right_fit_leaves_chi_squared_and_finds_the_number():
    _, base, (lag,) = searched(drawn(LAG), "velocity_lag")
    assert base.fit.excess > 800.0
    assert lag.fit.p > 1e-3
    error = lag.fit.x[0] - 3e-4
    assert abs(error) < 4.0 * np.sqrt(lag.fit.covariance[0, 0])


def test_intervals_cover_the_truth():
    pulls = []
    for seed in range(15):
        _, _, (lag,) = searched(drawn(LAG, seed), "velocity_lag")
        pulls.append((lag.fit.x[0] - 3e-4) / np.sqrt(lag.fit.covariance[0, 0]))
    assert 0.5 < np.std(pulls) < 1.6
    assert abs(np.mean(pulls)) < 1.0


def test_amplitudes_within_their_prior_are_taken_up():
    _, base, _ = searched(drawn(std=0.02, off=0.02))
    assert base.fit.p > 1e-3
    np.testing.assert_allclose(base.fit.amplitudes(), 1.02 * AMPLITUDES, rtol=0.01)


def test_unknown_amplitudes_are_found():
    _, base, _ = searched(drawn(known=False))
    assert base.fit.p > 1e-3
    np.testing.assert_allclose(base.fit.amplitudes(), AMPLITUDES, rtol=0.02)


def test_an_uncertain_number_is_no_cause_within_its_spread():
    truth = {"friction_level": {"scale": 1.06}}
    _, base, _ = searched(drawn(truth, uncertain={"friction_level": 0.05}))
    assert base.fit.p > 1e-3
    assert base.fit.x[0] == pytest.approx(1.06, abs=0.01)


def test_gain_on_held_out_tests_reaches_the_noise():
    _, base, (lag,) = searched(drawn(LAG), "velocity_lag")
    measured = gain.measure(base.fit, lag.fit, lambda function, items: list(map(function, items)))
    assert {each.scheme for each in measured.held_out} == {"frequency", "amplitude"}
    assert measured.excess_removed > 0.95
    assert measured.interval is None  # six tests are too few for one


def test_retuning_alone_gains_nothing():
    _, base, (lag,) = searched(drawn(), "velocity_lag")
    measured = gain.measure(base.fit, lag.fit, lambda function, items: list(map(function, items)))
    base_square, extended, noise = measured.totals()
    assert extended == pytest.approx(base_square, rel=0.02)
    assert base_square == pytest.approx(noise, rel=0.2)
