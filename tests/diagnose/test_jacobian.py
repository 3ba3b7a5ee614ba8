"""Derivatives: of smooth responses, across a jump, next to locking; and scores, which come before any fit."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.synthetic import LAG, LEANING, base_of, drawn, lagging, searched
from wedgesweep import config
from wedgesweep.diagnose import score_test
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.jacobian import STEP, _smaller, accurate_jacobian, jacobian, step_sizes
from wedgesweep.diagnose.model import Model
from wedgesweep.diagnose.search import Search, base_fit


def test_across_a_jump_the_side_without_it_counts():
    smooth, jump = np.ones((2, 4, 3)), np.ones((2, 4, 3))
    jump[1, :, 2] = 50.0
    np.testing.assert_array_equal(_smaller(smooth, jump), smooth)
    np.testing.assert_array_equal(_smaller(jump, smooth), smooth)


def test_both_sides_tell_the_same_of_a_smooth_response():
    *_, lag = lagging()
    right, left = (jacobian(lag.model, lag.evaluation, side) for side in (1.0, -1.0))
    for one, other in zip(right, left, strict=True):
        assert np.abs(one - other).max() < 0.1 * np.abs(one).max()


def test_steps_change_no_test_by_more_than_its_noise():
    """Steps sized for a bench of usual noise, on records that are a hundred times as exact."""
    *_, (lag,) = searched(drawn(LAG, level=4e-4), "velocity_lag")
    model = replace(lag.model, tolerance=1e-9)
    here = model.evaluate(lag.point)
    found = accurate_jacobian(model, here)
    assert largest_change(model, found, step_sizes(model)) > 5.0
    sizes = step_sizes(model, found)
    assert largest_change(model, found, sizes) == pytest.approx(1.0)
    for one, other in zip(found, accurate_jacobian(model, here, -1.0), strict=True):
        np.testing.assert_allclose(one, other, atol=0.01 * np.abs(one).max())


def test_steps_change_a_test_by_more_than_the_error_of_its_simulation():
    *_, (lag,) = searched(drawn(LAG, level=4e-4), "velocity_lag")
    model = replace(lag.model, tolerance=1e-4)
    found = jacobian(model, model.evaluate(lag.point))
    assert largest_change(model, found, step_sizes(model, found)) > 5.0


def test_what_is_held_or_exact_is_not_simulated(monkeypatch):
    *_, lag = lagging()
    model, here = lag.model, lag.evaluation
    free, scenarios = jacobian(model, here), []
    one = type(model.data).changes
    monkeypatch.setattr(type(model.data), "changes", lambda *given: scenarios.extend(given[2]) or one(*given))
    held = jacobian(model.holding(slice(None), here.point.x), here)
    assert len(scenarios) == 1
    assert not held.by_parameter.any()
    np.testing.assert_array_equal(held.by_nuisance, free.by_nuisance)
    stated = model.on(replace(model.data, amplitude_std=np.zeros(model.data.tests)))
    exact = jacobian(stated, here)
    assert len(scenarios) == 2
    np.testing.assert_array_equal(exact.by_parameter, free.by_parameter)


def largest_change(model, derivatives, sizes):
    """Of any test by the first parameter, in noise."""
    squared = (derivatives.by_parameter[..., 0] ** 2).sum(axis=1) / model.data.observations
    return sizes[0] * np.sqrt(squared).max()


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


EFFECTS = (
    "velocity_lag",
    "stray_vibration",
    "viscous_damping",
    "stribeck",
    "cross_slip",
    "fixture_resonance",
)
# Number with which an effect fades, its key's unit in SI, and its other numbers.
FADING = {
    "velocity_lag": ("time", 1.0, {}),
    "cross_slip": ("velocity", 1e-3, {"phase": 0.0}),
    "stribeck": ("velocity", 1e-3, {"peak": 0.0}),
}


def scored(effects=None):
    search, base, *_ = base_fit(Search.of(drawn(effects), EFFECTS))
    return {each.effect: each for each in score_test.scores(search, base, {})}


def test_an_effect_that_is_there_scores_and_one_that_is_not_does_not():
    lag = {"velocity_lag": {"time": 3e-4}}
    assert scored(lag)["velocity_lag"].t2 > 100.0
    assert scored()["velocity_lag"].t2 < 16.0


@pytest.mark.acceptance
def test_the_weakest_value_is_what_the_tests_would_have_shown():
    """Even where all of the range that a fit looks in would show, or the first number is not what fades."""
    weakest = scored()
    assert weakest["stribeck"].key == "velocity_mm_per_s"
    assert weakest["fixture_resonance"].key == "frequency_hz"
    for effect, (name, unit, others) in FADING.items():
        detectable = unit * weakest[effect].detectable
        stronger, weaker = ({effect: {name: factor * detectable, **others}} for factor in (4.0, 0.25))
        assert scored(stronger)[effect].t2 > score_test.DETECTABLE > scored(weaker)[effect].t2


def test_an_undetected_tone_has_a_detectable_strength():
    tone_undetected = scored()["stray_vibration"]
    assert tone_undetected.t2 is None
    assert tone_undetected.testable
    assert 0.0 < tone_undetected.detectable < 0.1


@pytest.mark.parametrize("known", [True, False])
def test_nuisances_take_out_start_phases_and_amplitudes_as_far_as_these_are_unknown(known):
    fit = base_of(drawn(std=1e-6, known=known))
    phase, amplitude = np.moveaxis(jacobian(fit.model, fit.evaluation).by_nuisance, -1, 0)
    project = score_test.Projector(fit)
    assert np.linalg.norm(project(phase)) < 1e-6 * np.linalg.norm(phase)
    along = np.einsum("tm,tm->t", phase, amplitude) / np.einsum("tm,tm->t", phase, phase)
    left = (amplitude - along[:, None] * phase) * known
    assert project(amplitude)[: left.size] == pytest.approx(left.ravel(), abs=1e-3 * np.abs(amplitude).max())
