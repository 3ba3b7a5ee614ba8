"""Draws from a fitted model are data of that model, and thresholds come from what a search finds in them."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.synthetic import LAG, drawn, searched
from tests.diagnose.test_aliasing import bench
from wedgesweep.diagnose import calibration, verdict
from wedgesweep.diagnose.calibration import calibrate
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.steady.model import Model
from wedgesweep.diagnose.steady.spectra import SIMULATED

DRAWS = 40


def coherent(share):
    data = drawn()
    return replace(data, spectra=tuple(replace(s, coherence=share) for s in data.spectra))


@pytest.mark.parametrize("data", [drawn(), coherent(0.6 + 0.3j), bench(SIMULATED)])
def test_a_draw_is_noise_about_the_fit(data):
    fit = Search(data, ()).base().fit
    rng = np.random.default_rng(3)
    squares = []
    for _ in range(DRAWS):
        again = Model(calibration.bootstrap_sample(fit, rng), fit.model.hypothesis, fit.model.reference)
        evaluation = again.evaluate(fit.evaluation.point)
        squares.append((evaluation.residual**2).sum())
        assert (evaluation.aliased == fit.evaluation.aliased).all()
    # Start phases are fitted again.
    expected = data.observations.sum() - data.tests
    assert np.mean(squares) == pytest.approx(expected, abs=4.0 * np.sqrt(2.0 * expected / DRAWS))


def alone(effect):
    """A search that tries one effect."""

    def explain(search):
        base = search.base()
        return base, [search.single(effect, base.fit)]

    return explain


def test_a_cause_that_is_found_again_is_strong_however_small(monkeypatch):
    monkeypatch.setattr(calibration, "DRAWS", 3)
    _, base, (lag,) = searched(drawn(LAG), "velocity_lag")
    told = []
    found = calibrate(base, lag, alone("velocity_lag"), ("velocity_lag",), 1, told.append)
    assert found.found == 1.0
    assert found.thresholds.strong == 0.0
    # A number costs more than noise gives.
    assert found.least_gain < verdict.GAP
    assert told[-1] == "calibration, velocity_lag: 3 of 3"


def test_a_cause_that_is_not_found_again_stays_weak(monkeypatch):
    monkeypatch.setattr(calibration, "DRAWS", 3)
    _, base, (lag,) = searched(drawn(LAG), "velocity_lag")
    found = calibrate(base, lag, alone("cubic_stiffness"), ("cubic_stiffness",), 1, lambda step: None)
    assert found.found == 0.0
    assert found.thresholds.strong == np.inf


def test_draws_whose_base_model_has_no_response_say_nothing_of_a_gain():
    gains = np.array([np.inf, 3.0, -np.inf, np.nan])
    assert calibration.Calibration(gains, None).least_gain == 3.0
    assert calibration.Calibration(gains[:1], None).least_gain == 0.0
