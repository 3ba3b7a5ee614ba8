"""Recommended tests are worth making: they separate explanations, and their data can be fitted."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.synthetic import LEANING, drawn, searched, steady_test, steady_tests
from wedgesweep import config
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.diagnose.next_test.designs import offered
from wedgesweep.diagnose.next_test.recommend import SEPARATED, choice
from wedgesweep.diagnose.next_test.steady import ACCELERATIONS, FREQUENCIES
from wedgesweep.diagnose.steady import simulation
from wedgesweep.solvers.periodic import at_rest

SHAPE = (ACCELERATIONS.size, FREQUENCIES.size)
FAR = 10.0 * SEPARATED


def explained(effect, values, std):
    """A Coulomb fit of one effect, its numbers known to some standard deviations."""
    data = replace(drawn(), law="coulomb", model=config.parse(LEANING))
    model = Model(data, Hypothesis((effect,)))
    x = model.hypothesis.at({effect: values})
    evaluation = model.evaluate(model.start(None, x))
    return Fit(model, evaluation, np.diag(np.atleast_1d(std)) ** 2.0, True)


def gain(fit, test, factor):
    """Fundamental of the response over the input, at a test whose amplitude is off by a factor."""
    omega = np.array([2.0 * np.pi * test.numbers["frequency_hz"]])
    amplitude = np.array([factor * 1e-3 * test.numbers["amplitude_mm"]])
    data = fit.model.data
    rows = simulation.records(data.model, data.law, fit.model.values(fit.x), omega, amplitude)
    return abs(simulation.respond(rows, at_rest(1), 1).harmonics[0, 0, 0]) / amplitude[0]


@pytest.fixture(scope="module")
def suspects():
    return [
        explained("friction_level", {"scale": 0.74}, 0.01),
        explained("bolster_stiffness", {"scale": 1.18}, 0.01),
    ]


def test_the_next_test_makes_every_suspect_move(suspects):
    """Next to breakaway Coulomb predictions are as far apart as one likes, and as hard to fit."""
    test = steady_test(suspects)
    assert test.closest.separated
    assert set(test.closest.names) == {"friction_level", "bolster_stiffness"}
    assert test.pairs == (test.closest,)
    for fit in suspects:
        assert gain(fit, test, 0.8) > 0.5 * gain(fit, test, 1.0) > 1e-3


def test_a_suspect_whose_wedge_locks_is_not_in_the_way(suspects):
    locking = explained("directional_friction", {"asymmetry": 0.4}, 0.01)
    assert not any(fit is locking for fit in offered(steady_tests(suspects), [*suspects, locking]).fits)
    assert steady_test([*suspects, locking]) == steady_test(suspects)
    assert steady_test([suspects[0], locking]) is None


def test_the_cheapest_test_is_chosen_that_would_do_with_a_neighbour_s_amplitude():
    distances = np.zeros((1, *SHAPE))
    distances[0, 0, 0] = FAR  # alone
    distances[0, 3:, 4] = FAR
    distances[0, 5:, 7] = 2.0 * FAR
    assert choice(distances) == np.ravel_multi_index((4, 4), SHAPE)


def test_a_pair_that_nothing_tells_apart_does_not_spoil_the_others():
    distances = np.zeros((2, *SHAPE))
    distances[0, 1:4, 2] = FAR
    distances[1, 6, 9] = 0.5 * SEPARATED
    assert choice(distances) == np.ravel_multi_index((2, 2), SHAPE)


def test_where_none_tells_enough_the_farthest_is_chosen():
    distances = np.full((2, *SHAPE), 0.1)
    distances[:, 5:, 6] = 0.4 * SEPARATED
    assert choice(distances) in np.ravel_multi_index(([6, 7], [6, 6]), SHAPE)


def test_what_the_tests_leave_open_only_makes_a_next_test_tell_less():
    """Covariances as large as 1e30 stand for numbers of which the tests say nothing."""
    data = drawn({"velocity_lag": {"time": 3e-4}}, known=False)
    *_, found = searched(data, "velocity_lag", "displacement_gain")
    usual, undetermined = (
        offered(
            steady_tests(found), [replace(fit, covariance=factor * fit.covariance) for fit in found]
        ).distances
        for factor in (1.0, 1e30)
    )
    assert (usual > 0.0).all()
    assert (undetermined <= usual).all()
    assert undetermined.mean() < 0.9 * usual.mean()


def test_what_a_model_may_be_wrong_by_separates_no_explanations(suspects):
    """An error of 5 % of the response is far more than what noise of 4 % of a sample leaves in a harmonic."""
    fit = suspects[0]
    exact, wrong = (replace(fit.model.data, model_error=error) for error in (0.0, 0.05))
    both = [steady_tests([replace(fit, model=fit.model.on(data))]).data for data in (exact, wrong)]
    moves = np.abs(both[0].measured[:, 0, 0]) > 0.0
    assert moves.mean() > 0.5
    assert (both[1].weight[moves] < both[0].weight[moves] / 5.0).all()
