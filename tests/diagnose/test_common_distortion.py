"""Stated inputs that all have the same harmonics, which are uncertain: fitted with a prior."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from tests.diagnose.test_stated_input import (
    AMPLITUDE,
    FREQUENCIES,
    STD,
    distorted,
    finding_of,
    frictionless,
    receptance,
)
from wedgesweep import config
from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.diagnosis import diagnose
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.model import Model
from wedgesweep.diagnose.result.estimates import uncertain
from wedgesweep.diagnose.result.extended_config import extended
from wedgesweep.diagnose.search import Search, base_fit
from wedgesweep.diagnose.steady.from_measurement import harmonic_data
from wedgesweep.diagnose.steady.whitened import real
from wedgesweep.uncertain import DISTORTION, uncertain_numbers

SECOND, THIRD = 0.7 * STD * np.exp(0.4j), 0.5 * STD * np.exp(-2.0j)


def declared(data, std=STD):
    return replace(data, uncertain={DISTORTION: std})


def derivatives(data, fit):
    """Of whitened residuals by the parts of both harmonics, from the transfer function; (T, m, 4)."""
    columns, phase = [], fit.evaluation.response.phase
    for order in (2, 3):
        response = np.zeros((data.tests, *data.shape), complex)
        for t, frequency in enumerate(FREQUENCIES):
            rate = 2j * pi * frequency * order
            response[t, :, order - 1] = -1j * AMPLITUDE * receptance(frequency, order) * np.array([1.0, rate])
        turned = data.rotated(response, phase)
        columns += [real(data.whiten(turn * turned)) for turn in (1.0, 1j)]
    return np.stack(columns, axis=-1)


def free_of_start_phases(slope, phase):
    """What start phases cannot take up of derivatives (T, m, n); ``phase`` (T, m, 1): those by them."""
    unit = phase / np.linalg.norm(phase, axis=1, keepdims=True)
    return slope - unit @ (np.swapaxes(unit, 1, 2) @ slope)


@pytest.mark.few(1)
@pytest.mark.parametrize("noise", [1e-4, 0.05])
def test_what_is_fitted_is_the_mean_of_the_posterior(noise):
    """A linear system: the data tell the harmonics where noise is small, the prior where it is not."""
    measurement = frictionless(3, std=0.0, noise=noise, common=(SECOND, THIRD))
    data = declared(harmonic_data(measurement))
    fit = base_fit(Search.of(data, ())).base
    slope = free_of_start_phases(derivatives(data, fit), data.eliminated_derivatives(fit.evaluation))
    precision = np.einsum("tmi,tmj->ij", slope, slope) + np.eye(4) / (0.5 * STD**2)
    expected = np.linalg.inv(precision)
    np.testing.assert_allclose(np.diag(fit.covariance), np.diag(expected), rtol=0.02)
    truth = np.array([SECOND.real, SECOND.imag, THIRD.real, THIRD.imag])
    # The prior pulls towards zero, and noise scatters what is left.
    mean = truth - expected @ truth / (0.5 * STD**2)
    assert (np.abs(fit.x - mean) < 4.0 * np.sqrt(np.diag(expected))).all()
    assert fit.p > 1e-3
    assert harmonic_data(measurement).uncertain == {}


def test_parts_and_harmonics_are_the_same_numbers():
    stated = {DISTORTION: {"second": 0.01, "second_phase": 2.0}}
    found = uncertain_numbers({"bolster_mass": 0.005, DISTORTION: STD, "input_gain": 0.02}, stated)
    assert found.mean == pytest.approx([1.0, 0.01 * np.cos(2.0), 0.01 * np.sin(2.0), 0.0, 0.0, 1.0])
    assert found.std == pytest.approx([0.005, *4 * [sqrt(0.5) * STD], 0.02])
    x = np.array([1.01, 0.003, -0.004, 0.0, 0.002, 0.98])
    values = found.values(x)
    assert values["bolster_mass"] == {"scale": 1.01}
    assert values[DISTORTION]["second"] == pytest.approx(0.005)
    assert found.by_key(x)[DISTORTION]["third_phase_deg"] == pytest.approx(90.0)
    np.testing.assert_allclose(found.at(values), x, atol=1e-12)
    # Nothing but a rounding error is none.
    assert found.values(np.r_[1.0, 4e-16, 0.0, 0.0, 1e-5, 1.0])[DISTORTION]["second"] == 0.0
    # What is not told is as stated.
    np.testing.assert_allclose(found.at({"bolster_mass": {"scale": 1.2}}), [1.2, *found.mean[1:]])


@pytest.mark.acceptance
def test_a_common_distortion_as_large_as_declared_is_not_missing():
    data = replace(distorted(STD), model_error=0.02)
    assert finding_of(data)[1].best.effects == (DISTORTION,)
    search, found = finding_of(declared(data))
    assert found.verdict == verdict.NOTHING
    values = Model(search.data, Hypothesis(())).uncertain.values(base_fit(search).base.x)[DISTORTION]
    for name in ("second", "third"):
        assert values[name] == pytest.approx(STD, rel=0.3)


def test_a_common_distortion_far_larger_than_declared_is_the_cause():
    _, found = finding_of(declared(replace(distorted(10.0 * STD), model_error=0.02)))
    assert found.verdict == verdict.NAMED
    assert found.best.effects == (DISTORTION,)
    for name in ("second", "third"):
        assert found.best.values[DISTORTION][name] == pytest.approx(10.0 * STD, rel=0.1)


@pytest.mark.acceptance
def test_a_cause_beside_a_common_distortion_is_named_alone():
    data = replace(distorted(STD, effects={"viscous_damping": {"coefficient": 8.0}}), model_error=0.02)
    _, found = finding_of(declared(data))
    assert found.verdict == verdict.NAMED
    assert found.best.effects == ("viscous_damping",)
    assert found.best.values["viscous_damping"]["coefficient_N_s_per_m"] == pytest.approx(8.0, rel=0.05)


def test_the_result_tells_the_fitted_harmonics():
    measurement = frictionless(3, std=0.0, common=(SECOND, THIRD))
    found = diagnose(replace(measurement, uncertain={DISTORTION: STD}), ("viscous_damping",))
    fitted = uncertain(found.base)[DISTORTION]
    for name, truth in (("second", SECOND), ("third", THIRD)):
        assert abs(fitted[name] - abs(truth)) < 4.0 * fitted[f"{name}_std"] < 0.2 * STD
        turned = np.exp(1j * np.radians(fitted[f"{name}_phase_deg"]))
        assert abs(fitted[name] * turned - truth) < 6.0 * fitted[f"{name}_std"]
    own = config.parse(extended(found)).effects[DISTORTION]
    assert own["third"] == pytest.approx(fitted["third"])
    assert own["third_phase"] == pytest.approx(np.radians(fitted["third_phase_deg"]))
