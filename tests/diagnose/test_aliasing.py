"""Aliases: harmonics above half the sampling rate, which a record shows among those below."""

from math import pi

import numpy as np
import pytest

from tests.diagnose.synthetic import base_of
from wedgesweep import config
from wedgesweep.diagnose.jacobian import jacobian
from wedgesweep.diagnose.model import TIGHT
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.harmonic_data import AMPLITUDE as LOG_AMPLITUDE
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.steady.spectra import SIMULATED, spectrum
from wedgesweep.solvers.periodic import at_rest

FREQUENCY = 31.266
# A bolster just above breakaway: it slips in short pulses.
PULSES = """
[suspension]
column_angle_deg = 4.0
[sweep]
friction_law = ["coulomb"]
beta = [1.0]
amplitude_mm = [0.01635]
"""
AMPLITUDE = 1.635e-5


def sampled(harmonics, ratio, periods=8.4, phase=0.0):
    """Times and signals (C, n) of harmonics (C, K), ``ratio`` samples a period."""
    time = np.arange(int(periods * ratio)) / (ratio * FREQUENCY)
    turns = np.exp(1j * np.arange(1, harmonics.shape[1] + 1)[:, None] * (2 * pi * FREQUENCY * time + phase))
    return time, (harmonics @ turns).real


@pytest.mark.parametrize("ratio", [20.3, 40.3, 49.5, 63.05, 130.0])
def test_aliases_are_what_is_read_beside_the_harmonics(ratio):
    rng = np.random.default_rng(0)
    harmonics = rng.normal(size=(2, SIMULATED, 2)) @ [1.0, 1j] / np.arange(1, SIMULATED + 1)
    time, channels = sampled(harmonics, ratio)
    found = spectrum(time, channels, FREQUENCY)
    aliases = found.mean - harmonics[:, : found.harmonics]
    np.testing.assert_allclose(aliases, found.alias_map(harmonics), atol=1e-9)
    assert np.abs(aliases).max() > 1e-3


def bench(highest, ratio=63.05, level=0.01):
    """Problem of one record of slip pulses that a low-pass has cut at harmonic ``highest``."""
    rng = np.random.default_rng(1)
    model = config.parse(PULSES)
    rows = simulation.records(model, "coulomb", {}, np.array([2.0 * pi * FREQUENCY]), np.array([AMPLITUDE]))
    harmonics = simulation.respond(rows, at_rest(1), SIMULATED, TIGHT).harmonics[0]
    time, channels = sampled(harmonics[:, :highest], ratio, phase=1.0)
    channels += level * channels.std(axis=1, keepdims=True) * rng.normal(size=channels.shape)
    found = spectrum(time, channels, FREQUENCY)
    return HarmonicData(model, "coulomb", ("one",), (found,), np.array([AMPLITUDE]), np.array([1e-4]), {})


@pytest.mark.parametrize(("highest", "aliased"), [(SIMULATED, True), (31, False)])
def test_the_right_model_leaves_noise_whether_or_not_the_record_was_low_passed(highest, aliased):
    fit = base_of(bench(highest))
    assert fit.p > 0.01
    assert fit.evaluation.response.aliased.all() == aliased


def test_pulses_sampled_often_enough_have_no_aliases():
    fit = base_of(bench(SIMULATED, ratio=400.0))
    assert fit.p > 0.01
    assert not fit.evaluation.response.aliased.any()


def test_without_their_aliases_the_pulses_are_not_explained():
    data = bench(SIMULATED)
    fit = base_of(data)
    left = data.whitened - data.rotated(fit.evaluation.response.whitened, fit.evaluation.response.phase)
    assert (np.abs(left) ** 2).sum() > 2.0 * fit.chi2


def test_aliases_are_part_of_the_derivatives():
    fit = base_of(bench(SIMULATED))
    here, point = fit.evaluation, fit.evaluation.point
    there = fit.model.evaluate(point.moved(np.zeros(0), np.array([LOG_AMPLITUDE.step])))
    by_nuisance = jacobian(fit.model, here).by_nuisance[0]
    expected = by_nuisance @ [there.response.phase[0] - here.response.phase[0], LOG_AMPLITUDE.step]
    change = there.residual[0] - here.residual[0]
    # Without the aliases 2.4 % would be left.
    assert np.linalg.norm(change - expected) < 0.012 * np.linalg.norm(change)
