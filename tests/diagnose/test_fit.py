"""Fits of problems whose truth is known: chi-squared, intervals, and what each unknown takes up."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.drawn import AMPLITUDES, LEANING, drawn
from wedgesweep import config
from wedgesweep.diagnose import gain, refine
from wedgesweep.diagnose.coordinates import Hypothesis
from wedgesweep.diagnose.model import Model
from wedgesweep.diagnose.refine import _covariance, exact
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.tangents import AMPLITUDE_WIDTH, STEP, _smaller, carried, tangents_of

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


def test_the_error_of_a_simulation_is_no_information():
    """A stiff end stop that two tests touch: amplitude, clearance and stiffness are hard to tell apart."""
    truth = {"end_stop": {"clearance": 3.5e-4, "stiffness": 2e5}}
    problem = drawn(truth, std=0.015, uncertain={"friction_level": 0.09})
    spectra = tuple(
        replace(s, mean=s.mean[:1], variance=s.variance[:1], level=s.level[:1]) for s in problem.spectra
    )
    _, _, (stop,) = searched(replace(problem, spectra=spectra), "end_stop")
    fine = exact(stop.fit)
    coarse, std = (np.sqrt(np.diag(fit.covariance)) for fit in (stop.fit, fine))
    np.testing.assert_allclose(coarse, std, rtol=0.1)
    assert fine.q == pytest.approx(stop.fit.q, abs=0.1)


def test_across_a_jump_the_side_without_it_counts():
    smooth, jump = np.ones((2, 4, 3)), np.ones((2, 4, 3))
    jump[1, :, 2] = 50.0
    np.testing.assert_array_equal(_smaller(smooth, jump), smooth)
    np.testing.assert_array_equal(_smaller(jump, smooth), smooth)


def test_both_sides_tell_the_same_of_a_smooth_response():
    *_, (lag,) = searched(drawn(LAG), "velocity_lag")
    right, left = (tangents_of(lag.fit.model, lag.fit.trial, side) for side in (1.0, -1.0))
    for one, other in zip(right, left, strict=True):
        assert np.abs(one - other).max() < 0.1 * np.abs(one).max()


@pytest.mark.parametrize("effects", [("velocity_lag",), ("velocity_lag", "friction_level")])
def test_carried_derivatives_agree_with_the_step_and_nothing_else(effects):
    problem = drawn(LAG, std=0.02, off=0.02)
    model = Model(problem, Hypothesis(effects), problem.amplitude)
    start = model.trial(model.start(None, 0.5 * (model.low + model.high)))
    shorter = replace(
        start.point, x=start.point.x + 0.3 * model.width, amplitude=np.full(problem.tests, 0.01)
    )
    reached = model.trial(shorter)
    before = tangents_of(model, start)
    after = carried(model, before, start, reached)

    def along(tangents, numbers, turned, amplitude):
        return (
            tangents.by_number @ numbers
            + tangents.by_test[..., 0] * turned[:, None]
            + tangents.by_test[..., 1] * amplitude
        )

    numbers = 0.3 * model.width
    step = along(after, numbers, reached.phase - start.phase, 0.01)
    np.testing.assert_allclose(
        step, reached.residual - start.residual, atol=1e-9 * np.abs(start.residual).max()
    )
    # Across the step (in widths) nothing was learned.
    other = -((numbers / model.width) ** 2).sum() * AMPLITUDE_WIDTH**2 / 0.01
    still = np.zeros(problem.tests)
    np.testing.assert_allclose(
        along(after, numbers, still, other), along(before, numbers, still, other), rtol=1e-9, atol=1e-9
    )
    # What the phase does is known.
    np.testing.assert_array_equal(after.by_test[..., 0], tangents_of(model, reached).by_test[..., 0])


def test_where_derivatives_are_carried_a_fit_ends_the_same(monkeypatch):
    problem = drawn(LAG, std=0.02, off=0.02)
    _, _, (carried,) = searched(problem, "velocity_lag")
    monkeypatch.setattr(refine, "TRUSTED", np.inf)
    _, _, (own,) = searched(problem, "velocity_lag")
    assert carried.fit.q == pytest.approx(own.fit.q, abs=2.0 * refine.ARRIVED)
    np.testing.assert_allclose(carried.fit.covariance, own.fit.covariance, rtol=0.05)


def test_next_to_where_a_wedge_locks_the_near_side_tells():
    """Without a derivative a number would look as if the tests told nothing of it, or everything."""
    problem = replace(drawn(), law="coulomb", model=config.parse(LEANING))
    model = Model(problem, Hypothesis(("directional_friction",)), problem.amplitude)

    def trial(asymmetry):
        return model.trial(model.start(None, np.array([asymmetry])))

    free, locked = 0.0, 0.4
    step = STEP * model.width[0]
    assert trial(free).found
    assert not trial(locked).found
    while locked - free > 0.5 * step:
        middle = 0.5 * (free + locked)
        free, locked = (middle, locked) if trial(middle).found else (free, middle)
    beyond, near = (tangents_of(model, trial(free), side) for side in (1.0, -1.0))
    assert np.abs(near[0]).max() > 0.0
    np.testing.assert_array_equal(beyond[0], near[0])


def test_what_the_equations_leave_open_is_wide():
    """A number without any trace, and two that do the same."""
    covariance = _covariance(np.array([[4.0, 0.0, 0.0], [0.0, 9.0, 9.0], [0.0, 9.0, 9.0]]))
    assert covariance[0, 0] == pytest.approx(0.25)
    assert covariance[1, 1] > 1e6
    assert _covariance(np.diag([4.0, 0.0]))[1, 1] > 1e6


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


def test_what_a_test_tells_of_its_own_amplitude_is_not_left_as_noise():
    """Squared misfit of a right model, less what noise should leave."""
    for std, known, least, most in ((1e-5, True, 1.0, 1.05), (0.5, True, 1.9, 2.0), (0.0, False, 2.0, 2.0)):
        left = []
        for seed in range(12):
            _, base, _ = searched(drawn(seed=seed, std=std, known=known))
            local = gain._local_numbers(base.fit)
            assert ((least <= local) & (local <= most)).all()
            left.append((base.fit.trial.residual**2).sum() - (base.fit.model.problem.points - local).sum())
        assert np.mean(left) == pytest.approx(0.0, abs=3.0 * np.sqrt(2.0 * 384 / 12))


def test_retuning_alone_gains_nothing():
    _, base, (lag,) = searched(drawn(), "velocity_lag")
    measured = gain.measure(base.fit, lag.fit, lambda function, items: list(map(function, items)))
    base_square, extended, noise = measured.totals()
    assert extended == pytest.approx(base_square, rel=0.02)
    assert base_square == pytest.approx(noise, rel=0.2)
