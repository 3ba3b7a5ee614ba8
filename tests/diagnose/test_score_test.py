"""Scores: what the tests could show of each effect before anything is fitted."""

import numpy as np
import pytest

from tests.diagnose.synthetic import base_of, drawn
from wedgesweep.diagnose import score_test
from wedgesweep.diagnose.jacobian import jacobian
from wedgesweep.diagnose.search import Search, base_fit

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
    return {each.effect: each for each in score_test.scores(search, base.fit, {})}


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
