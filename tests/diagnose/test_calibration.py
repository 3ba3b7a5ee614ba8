"""Bootstrap samples are data of the fitted model, and thresholds come from what a search finds in them."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.synthetic import LAG, base_of, drawn, searched
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


def alone(effect):
    """A search that tries one effect."""

    def explain(search):
        search, base, *_ = base_fit(search)
        return base, [single_fit(search, effect, base.fit).explanation]

    return explain


def test_a_cause_that_is_found_again_is_strong_however_small(monkeypatch):
    monkeypatch.setattr(calibration, "SAMPLES", 3)
    messages = []
    search, base, (lag,) = searched(drawn(LAG), "velocity_lag")
    search = replace(search, progress=messages.append)
    found = calibrate(search, base, lag, alone("velocity_lag"), ("velocity_lag",))
    assert found.found == 1.0
    assert found.thresholds.strong == 0.0
    # A number costs more than noise gives.
    assert found.least_gain < verdict.GAP
    assert messages[-1] == "calibration, velocity_lag: 3 of 3"


def test_a_cause_that_is_not_found_again_stays_weak(monkeypatch):
    monkeypatch.setattr(calibration, "SAMPLES", 3)
    search, base, (lag,) = searched(drawn(LAG), "velocity_lag")
    found = calibrate(search, base, lag, alone("cubic_stiffness"), ("cubic_stiffness",))
    assert found.found == 0.0
    assert found.thresholds.strong == np.inf


def test_samples_without_a_response_of_the_base_model_do_not_count():
    gains = np.array([np.inf, 3.0, -np.inf, np.nan])
    assert calibration.Calibration(gains, None).least_gain == 3.0
    assert calibration.Calibration(gains[:1], None).least_gain == 0.0
