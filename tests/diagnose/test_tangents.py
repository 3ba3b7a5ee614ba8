"""Derivatives: of smooth responses, across a jump, next to locking, and carried along."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.drawn import LAG, LEANING, drawn, searched
from wedgesweep import config
from wedgesweep.diagnose.coordinates import Hypothesis
from wedgesweep.diagnose.model import Model
from wedgesweep.diagnose.tangents import AMPLITUDE_WIDTH, STEP, _smaller, carried, tangents_of


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
