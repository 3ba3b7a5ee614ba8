"""Waveforms of measured and simulated tests, and the force that a model lacks, seen from them."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL, base_of, drawn, searched
from wedgesweep import config, response
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.diagnose.steady import simulation, waveforms
from wedgesweep.diagnose.steady.spectra import spectrum
from wedgesweep.solvers import event_driven, periodic
from wedgesweep.solvers.trajectory import Window

DAMPING, DRY = 8.0, 0.1
DAMPER = {"viscous_damping": {"coefficient": DAMPING}}
GUIDE = {"guide_friction": {"force": DRY}}


def seen(level, effects, *numbers):
    """Residual force (N) of the base model and the deflection's rate (m/s); input and its phase are known."""
    data = drawn(effects, level=level)
    model = Model(data, Hypothesis(()))
    evaluation = model.evaluate(model.start(None, np.zeros(0)))
    true = Model(data, Hypothesis(tuple(effects)))
    phase = true.evaluate(true.start(None, np.array(numbers))).response.phase
    response = evaluation.response._replace(phase=phase)
    fit = Fit(model, replace(evaluation, response=response), np.zeros((0, 0)), True)
    harmonics = waveforms.measured_from_phase_zero(data, fit)
    rate = waveforms.velocity(data, harmonics)
    force = waveforms.residual_force(data, fit, harmonics)
    return force, -waveforms.waveform(rate)


def left(force, law):
    """Share of a force that a law does not give, over all tests."""
    return np.sqrt(((force - law) ** 2).sum() / (law**2).sum())


@pytest.mark.parametrize("level", [1e-4, 0.04])
def test_a_damper_that_is_missing(level):
    force, v = seen(level, DAMPER, DAMPING)
    assert left(force, -DAMPING * v) < 0.3


@pytest.mark.parametrize("level", [1e-4, 0.04])
def test_a_guide_s_friction_that_is_missing(level):
    force, v = seen(level, GUIDE, DRY)
    assert left(force, -DRY * np.sign(v)) < 0.4


@pytest.mark.parametrize("level", [1e-4, 0.04])
def test_nothing_is_left_of_the_right_model(level):
    """What noise and the jumps of friction leave is small beside what such a damper would."""
    force, v = seen(level, {})
    assert left(force + DAMPING * v, DAMPING * v) < 0.3


def test_effects_with_mechanics_of_their_own_leave_no_force_to_tell():
    model = MODEL + "[effects.viscous_damping]\ncoefficient_N_s_per_m = 5.0\n"
    data = drawn(model=model)
    fit = base_of(data)
    assert np.isnan(waveforms.residual_force(data, fit, data.measured)).all()


@pytest.mark.parametrize("effects", ["", "[effects.input_gain]\nscale = 1.2\n"])
def test_the_base_supplies_what_friction_takes(effects):
    data = drawn(model=MODEL + effects)
    model = Model(data, Hypothesis(()))
    fit = Fit(model, model.evaluate(model.start(None, np.zeros(0))), np.zeros((0, 0)), True)
    supplied = waveforms.input_energy(data, fit, fit.evaluation.response.harmonics[:, 0, 0])
    records = simulation.records(data.model, data.law, {}, data.omega, data.amplitude)
    for energy, record in zip(supplied, np.split(records, data.tests), strict=True):
        run = event_driven.solve(record, Window(float(record["input"]["omega"][0]), 60, 2, 256), 1e-9, 60.0)
        taken = response.evaluate(run, record, 1).numbers["dissipated_energy"]
        assert energy == pytest.approx(taken, rel=1e-4)


def test_the_energy_of_measured_tests_is_that_of_the_true_system():
    """A heavier bolster on inputs that are not quite those stated: the base model takes both up elsewhere."""
    heavier, off = {"bolster_mass": {"scale": 1.1}}, 0.03
    data = drawn(heavier, std=0.05, off=off)
    _, base, (extended,) = searched(data, "bolster_mass")
    model = Model(data, Hypothesis(("bolster_mass",)))
    point = model.start(None, np.array([1.1])).moved(np.zeros(1), np.log([1.0 + off]))
    true = Fit(model, model.evaluate(point), np.zeros((1, 1)), True)
    energy = waveforms.input_energy(data, true, true.evaluation.response.harmonics[:, 0, 0])

    def measured(fit):
        return waveforms.input_energy(data, fit, waveforms.measured_from_phase_zero(data, fit)[:, 0, 0])

    np.testing.assert_allclose(measured(extended), energy, rtol=0.03)
    assert np.abs(measured(base) / energy - 1.0).max() > 0.1


@pytest.mark.parametrize("effect", ["displacement_gain]\nscale = 1.1", "velocity_lag]\ntime_s = 3e-4"])
def test_channels_that_are_not_the_motion_tell_no_force(effect):
    data = drawn(model=f"{MODEL}[effects.{effect}\n")
    fit = base_of(data)
    assert np.isnan(waveforms.residual_force(data, fit, data.measured)).all()


def test_a_fixture_takes_energy_that_the_data_do_not_tell():
    data = drawn(model=f"{MODEL}[effects.fixture_resonance]\nfrequency_hz = 60.0\ndamping_ratio = 0.05\n")
    fit = base_of(data)
    assert np.isnan(waveforms.input_energy(data, fit, fit.evaluation.response.harmonics[:, 0, 0])).all()


TONE, PERIODS, PER_PERIOD = 47.3, 8.4, 512
FREQUENCIES, AMPLITUDES = np.array([7.5, 20.0, 32.0]), 1e-3 * np.array([0.6, 0.11, 0.06])


def rows(phase):
    """Parameters of three tests under a strong tone."""
    stray = {"stray_vibration": {"acceleration": 0.3, "frequency": TONE, "phase": phase}}
    return simulation.records(
        config.parse(MODEL), "static-dynamic", stray, 2.0 * pi * FREQUENCIES, AMPLITUDES
    )


@pytest.mark.parametrize("begin", [0, 77, 400])
def test_input_and_tone_meet_as_in_the_record(begin):
    """Records that begin anywhere, under a tone of any phase, have the harmonics that are simulated."""
    at_rest = periodic.at_rest(3).state
    x, velocity = periodic.sampled(rows(1.9), at_rest, 30, 10, PER_PERIOD, 1e-8)[:2]
    count = round(PERIODS * PER_PERIOD)
    signals = -np.stack([x, velocity], axis=1)
    signals += (
        1e-4 * signals.std(axis=2, keepdims=True) * np.random.default_rng(begin).normal(size=signals.shape)
    )
    timings, measured = [], []
    for i, frequency in enumerate(FREQUENCIES):
        time = np.arange(count) / (frequency * PER_PERIOD)
        found = spectrum(time, signals[i][:, begin : begin + count], frequency, TONE)
        start = 2.0 * pi * begin / PER_PERIOD
        timings.append(simulation.ToneTiming(PERIODS, start, float(np.angle(found.mean[0, -1]))))
        turned_back = np.exp(-1j * start * np.arange(1, 17))
        measured.append(found.mean * np.r_[turned_back, 1.0])
    done = simulation.respond_with_tone(rows(0.0), periodic.at_rest(3), 16, TONE, timings)
    for simulated, real in zip(done.harmonics, measured, strict=True):
        for one, other in zip(simulated, real, strict=True):
            assert np.abs(one[:-1] - other[:-1]).max() < 2e-3 * np.abs(other).max()
            assert abs(one[-1]) == pytest.approx(abs(other[-1]), rel=0.02)
