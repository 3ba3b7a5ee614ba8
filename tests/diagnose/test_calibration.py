"""Bootstrap samples are data of the fitted model, and thresholds come from what a search finds in them."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.synthetic import base_of, drawn, lagging
from tests.diagnose.test_aliasing import bench
from wedgesweep.diagnose import calibration, verdict
from wedgesweep.diagnose.calibration import calibrate
from wedgesweep.diagnose.model import Model
from wedgesweep.diagnose.search import base_fit, single_fit
from wedgesweep.diagnose.steady.spectra import SIMULATED

SAMPLES = 40


def coherent(share):
    data = drawn()
    return replace(data, spectra=tuple(replace(s, coherence=share) for s in data.spectra))


@pytest.mark.parametrize("make", [drawn, lambda: coherent(0.6 + 0.3j), lambda: bench(SIMULATED)])
def test_a_sample_is_noise_about_the_fit(make):
    data = make()
    fit = base_of(data)
    rng = np.random.default_rng(3)
    squares = []
    for _ in range(SAMPLES):
        again = Model(data.bootstrap_sample(fit.evaluation, rng), fit.model.hypothesis)
        evaluation = again.evaluate(fit.evaluation.point)
        squares.append((evaluation.residual**2).sum())
        assert (evaluation.response.aliased == fit.evaluation.response.aliased).all()
    # Start phases are fitted again.
    expected = data.observations.sum() - data.tests
    assert np.mean(squares) == pytest.approx(expected, abs=4.0 * np.sqrt(2.0 * expected / SAMPLES))


@pytest.mark.parametrize(
    ("tried", "again", "strong"), [("velocity_lag", 1.0, 0.0), ("cubic_stiffness", 0.0, np.inf)]
)
def test_a_cause_that_is_found_again_is_strong_however_small(tried, again, strong, monkeypatch):
    def explain(search):
        known = base_fit(search)
        return known.joined([single_fit(known.search, tried, known.base).fit])

    monkeypatch.setattr(calibration, "SAMPLES", 3)
    monkeypatch.setattr(calibration, "explain", explain)
    messages = []
    search, base, lag = lagging()
    found = calibrate(replace(search, progress=messages.append), base, lag)
    assert (found.found, found.thresholds.strong) == (again, strong)
    # A number costs more than noise gives.
    assert found.least_gain < verdict.GAP
    assert messages[-1] == "calibration, velocity_lag: 3 of 3"


def test_samples_without_a_response_of_the_base_model_do_not_count():
    gains = np.array([np.inf, 3.0, -np.inf, np.nan])
    assert calibration.Calibration(gains, None).least_gain == 3.0
    assert calibration.Calibration(gains[:1], None).least_gain == 0.0
