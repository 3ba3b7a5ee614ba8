"""Responses as a record shows them."""

from math import pi

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL
from wedgesweep import config
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.spectra import spectrum
from wedgesweep.solvers import periodic

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
