"""Stated inputs whose harmonics are uncertain: what a shaker distorts belongs to the covariance."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL as BENCH
from tests.diagnose.synthetic import drawn, measurement, record
from tests.diagnose.test_oscillator_data import FREQUENCY, C, K, M, model
from wedgesweep import config
from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.model import Model
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.stages import explain
from wedgesweep.diagnose.steady.from_measurement import harmonic_data
from wedgesweep.diagnose.steady.harmonic_data import stated
from wedgesweep.diagnose.steady.stated_input import distorted as with_harmonic
from wedgesweep.diagnose.steady.whitened import real

STD, AMPLITUDE, NOISE = 0.004, 1e-3, 1e-4
FREQUENCIES = np.array([FREQUENCY, 1.6 * FREQUENCY, 0.4 * FREQUENCY])


def receptance(frequency, orders):
    """Motion of the frictionless mass less that of its base, over the latter."""
    omega = 2.0 * np.pi * frequency * orders
    return M * omega**2 / (K + 1j * C * omega - M * omega**2)


def frictionless(seed=0, std=STD, distorted=False, noise=NOISE, velocity=True, common=(0.0, 0.0)):
    """Records of the frictionless oscillator, whose inputs may be distorted: each test in its own way.

    ``common``: second and third harmonic over the amplitude, complex, that all inputs have.
    """
    rng, orders = np.random.default_rng(seed), np.arange(1, 4)
    tests = []
    for frequency in FREQUENCIES:
        parts = np.array([0.0, 1.0, 1.0]) * STD * np.sqrt(0.5) * distorted
        given = -1j * np.array([1.0, *common]) + parts * (rng.normal(size=3) + 1j * rng.normal(size=3))
        motion = AMPLITUDE * given * receptance(frequency, orders)
        time = np.arange(4000) * 12.0 / frequency / 4000
        omega = 2.0 * np.pi * frequency * orders
        turns = np.exp(1j * np.outer(time + rng.uniform(0.0, 1.0 / frequency), omega))
        exact = np.array([(turns @ (motion * rate)).real for rate in (1.0, 1j * omega)])
        exact += noise * exact.std(axis=1, keepdims=True) * rng.normal(size=exact.shape)
        channels = {"displacement": exact[0], "velocity": exact[1] if velocity else None}
        tests.append(record(f"{frequency:g}", frequency, time, amplitude=AMPLITUDE, **channels))
    columns = {"displacement": {"column": "y", "unit": "m"}}
    return measurement(model("base", "base"), "coulomb", tests, columns, input_harmonics_std=std)


def closed_form(data):
    """Covariance of residuals: noise, and what the transfer function makes of each harmonic of the input."""
    tests, (channels, columns) = data.tests, data.shape
    found = np.tile(np.eye(2 * channels * columns), (tests, 1, 1))
    for order in (2, 3):
        response = np.zeros((tests, channels, columns), complex)
        for t, omega in enumerate(data.omega):
            there = AMPLITUDE * receptance(omega / (2.0 * np.pi), order)
            response[t, :, order - 1] = there * np.array([1.0, 1j * order * omega])[:channels]
        for turn in (1.0, 1j):
            column = np.sqrt(0.5) * STD * real(data.whiten(turn * response))
            found += column[:, :, None] * column[:, None, :]
    return found


@pytest.mark.few(1)
@pytest.mark.parametrize("velocity", [True, False])
@pytest.mark.parametrize("model_error", [0.0, 0.01])
def test_the_covariance_is_that_of_the_transfer_function(velocity, model_error):
    """A linear system passes each harmonic on by itself, whatever the start phase of a record."""
    given = frictionless(velocity=velocity)
    data = harmonic_data(replace(given, model_error=model_error))
    expected = closed_form(data)
    assert expected.max() > (1e3 if model_error == 0.0 else 3.0)
    np.testing.assert_allclose(data.covariance(stated(data)), expected, atol=1e-5 * expected.max())
    whitened = data.whitening @ expected @ np.swapaxes(data.whitening, 1, 2)
    np.testing.assert_allclose(whitened, np.tile(np.eye(expected.shape[1]), (3, 1, 1)), atol=0.02)


def with_uncertain_harmonics(data, std):
    data = replace(data, harmonics_std=std)
    return data.with_covariance(stated(data))


def chi2_over_dof(data, scenario):
    return (data.compare([scenario], 1e-8)[0].residual ** 2).sum() / data.dof.sum()


@pytest.mark.acceptance
def test_the_misfit_of_the_truth_has_the_size_of_its_covariance():
    """Over draws: the mean of chi-squared over its degrees of freedom has a standard error of 1.4 %."""
    with_covariance, without = [], []
    for seed in range(20):
        data = harmonic_data(frictionless(seed, distorted=True))
        with_covariance.append(chi2_over_dof(data, stated(data)))
        without.append(chi2_over_dof(data.bare(), stated(data)))
    assert np.mean(with_covariance) == pytest.approx(1.0, abs=0.04)
    assert np.mean(without) > 50.0


def distorted(size, seed=0, effects=None, level=0.02):
    """The bench with friction; the magnitude of both harmonics of the input, with any phase."""
    phases = np.random.default_rng([seed, 1]).uniform(-np.pi, np.pi, 2)
    harmonics = {"second": size, "second_phase": phases[0], "third": size, "third_phase": phases[1]}
    return drawn({"input_distortion": harmonics, **(effects or {})}, seed, level, std=0.001)


@pytest.mark.acceptance
@pytest.mark.parametrize(("std", "level"), [(0.25 * STD, 0.02), (STD, 0.04)])
def test_the_misfit_of_a_bench_with_friction_has_the_size_of_its_covariance(std, level):
    """Small harmonics are passed on in proportion; larger ones are not where they meet the resonance."""
    with_covariance, without = [], []
    for seed in range(10):
        bare = distorted(std, seed, level=level)
        data = with_uncertain_harmonics(bare, std)
        data = data.renewed(stated(data))
        with_covariance.append(chi2_over_dof(data, stated(data)))
        without.append(chi2_over_dof(bare, stated(data)))
    assert np.mean(with_covariance) == pytest.approx(1.0, abs=0.1)
    assert np.mean(without) > 5.0


def test_the_start_phase_is_the_best_one_under_the_covariance():
    data = with_uncertain_harmonics(distorted(STD), STD)
    here = Model(data, Hypothesis(())).evaluate(stated(data).point)
    phase, simulated = here.response.phase, here.response.whitened
    aliases = data.whiten(here.response.aliases)

    def misfit(turned):
        left = real(data.whitened - aliases - data.rotated(simulated, turned))
        return (data.decorrelated(left) ** 2).sum(-1)

    assert (misfit(phase) < np.minimum(misfit(phase - 1e-4), misfit(phase + 1e-4))).all()
    derivative = data.eliminated_derivatives(here)[..., 0]
    slope = 2.0 * (derivative * here.residual).sum(-1)
    assert (np.abs(slope) < 1e-4 * np.linalg.norm(derivative, axis=-1)).all()
    assert (np.abs(phase - data.bare().start_phase(simulated, aliases)) > 1e-4).any()


def test_the_derivative_by_the_start_phase_is_that_of_the_residual():
    data = with_uncertain_harmonics(distorted(STD), STD)
    here = Model(data, Hypothesis(())).evaluate(stated(data).point)
    turned = [
        data.decorrelated(real(-data.rotated(here.response.whitened, here.response.phase + step)))
        for step in (1e-5, -1e-5)
    ]
    np.testing.assert_allclose(
        data.eliminated_derivatives(here)[..., 0], (turned[0] - turned[1]) / 2e-5, rtol=1e-5, atol=1e-4
    )


def test_some_of_the_tests_are_compared_as_before():
    data = with_uncertain_harmonics(distorted(STD), STD)
    rows = np.array([1, 4])
    all_tests = Model(data, Hypothesis(())).evaluate(stated(data).point)
    some = Model(data.subset(rows), Hypothesis(())).evaluate(stated(data).point.subset(rows))
    np.testing.assert_allclose(some.chi2_by_test, all_tests.chi2_by_test[rows], rtol=1e-6)


# A third harmonic meets the resonance at 13.6 Hz.
EFFECTS = ("input_distortion", "viscous_damping", "displacement_gain")


def finding_of(data):
    search, base, found, _ = explain(Search.of(data, EFFECTS))
    return search, verdict.decide(base, found, verdict.thresholds_for(search.data))


def test_a_distortion_ten_times_as_large_is_named():
    data = with_uncertain_harmonics(replace(distorted(10.0 * STD), model_error=0.02), STD)
    search, found = finding_of(data)
    assert found.verdict == verdict.NAMED
    assert found.best.effects == ("input_distortion",)
    fit = found.best
    for name in ("second", "third"):
        assert fit.values["input_distortion"][name] == pytest.approx(10.0 * STD, rel=0.1)
    assert fit.model.data is search.data
    assert search.data.renewed(fit.model.scenario(fit.point)) is search.data


@pytest.mark.acceptance
def test_a_cause_beside_a_distortion_as_large_as_declared_is_named_alone():
    data = replace(distorted(STD, effects={"viscous_damping": {"coefficient": 8.0}}), model_error=0.02)
    _, paired = finding_of(data)
    assert set(paired.best.effects) == {"viscous_damping", "input_distortion"}
    _, found = finding_of(with_uncertain_harmonics(data, STD))
    assert found.verdict == verdict.NAMED
    assert found.best.effects == ("viscous_damping",)
    assert found.best.values["viscous_damping"]["coefficient_N_s_per_m"] == pytest.approx(8.0, rel=0.05)


def test_a_model_that_distorts_is_distorted_further():
    own = BENCH + "[effects.input_distortion]\nsecond = 0.01\nsecond_phase_deg = 30.0\n"
    data = with_uncertain_harmonics(replace(distorted(STD), model=config.parse(own)), STD)
    moved = with_harmonic(data, {}, "second", 0.01)["input_distortion"]
    both = 0.01 * np.exp(1j * np.radians(30.0)) + 0.01
    assert moved["second"] == pytest.approx(abs(both))
    assert moved["second_phase"] == pytest.approx(np.angle(both))
