"""Derivatives: of smooth responses, across a jump, and next to locking."""

from dataclasses import replace

import numpy as np

from tests.diagnose.synthetic import LAG, LEANING, drawn, searched
from wedgesweep import config
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.jacobian import STEP, _smaller, jacobian
from wedgesweep.diagnose.model import Model


def test_across_a_jump_the_side_without_it_counts():
    smooth, jump = np.ones((2, 4, 3)), np.ones((2, 4, 3))
    jump[1, :, 2] = 50.0
    np.testing.assert_array_equal(_smaller(smooth, jump), smooth)
    np.testing.assert_array_equal(_smaller(jump, smooth), smooth)


def test_both_sides_tell_the_same_of_a_smooth_response():
    *_, (lag,) = searched(drawn(LAG), "velocity_lag")
    right, left = (jacobian(lag.fit.model, lag.fit.evaluation, side) for side in (1.0, -1.0))
    for one, other in zip(right, left, strict=True):
        assert np.abs(one - other).max() < 0.1 * np.abs(one).max()


def test_next_to_where_a_wedge_locks_the_near_side_tells():
    """Without a derivative a parameter would look undetermined, or exactly known."""
    data = replace(drawn(), law="coulomb", model=config.parse(LEANING))
    model = Model(data, Hypothesis(("directional_friction",)))

    def at(asymmetry):
        return model.evaluate(model.start(None, np.array([asymmetry])))

    free, locked = 0.0, 0.4
    step = STEP * model.scale[0]
    assert at(free).found
    assert not at(locked).found
    while locked - free > 0.5 * step:
        middle = 0.5 * (free + locked)
        free, locked = (middle, locked) if at(middle).found else (free, middle)
    beyond, near = (jacobian(model, at(free), side) for side in (1.0, -1.0))
    assert np.abs(near[0]).max() > 0.0
    np.testing.assert_array_equal(beyond[0], near[0])
