"""Frequency and drift of a record: as accurate as the noise allows, and honest about it."""

from math import pi

import numpy as np
import pytest
from scipy.signal import lfilter

from wedgesweep.measured.cycles import cut
from wedgesweep.measured.frequency import (
    _search,
    estimate_frequency,
    estimate_near,
    refined_frequency,
    stands_out,
)

SAMPLING = 2000.0
SINE = {1: 1.0}
STRONG_HARMONICS = {1: 1.0, 2: 0.2, 3: 0.5, 5: 0.15}
WEAK_FUNDAMENTAL = {1: 0.2, 2: 0.1, 3: 1.0, 5: 0.2}


def record(random, frequency, periods, amplitudes, level, correlation=0.0, change=0.0):
    """Time and a vibration of harmonics with random phases, a constant part and noise over its rms."""
    t = np.arange(int(periods / frequency * SAMPLING)) / SAMPLING
    phase = 2.0 * pi * frequency * (t + 0.5 * change * t * (t / t[-1] - 1.0))
    signal = 3.0 + sum(a * np.cos(k * phase + random.uniform(0.0, 2.0 * pi)) for k, a in amplitudes.items())
    rms = np.sqrt(0.5 * sum(a * a for a in amplitudes.values()))
    fresh = random.normal(size=t.size + 200) * np.sqrt(1.0 - correlation**2)
    return t, signal + level * rms * lfilter([1.0], [1.0, -correlation], fresh)[200:]


def cramer_rao(periods, frequency, amplitudes, level):
    """Least std (Hz) of an unbiased estimate under white noise (Rife and Boorstyn, 1974; with harmonics)."""
    t = np.arange(int(periods / frequency * SAMPLING)) / SAMPLING
    rms = np.sqrt(0.5 * sum(a * a for a in amplitudes.values()))
    curvature = sum((k * a) ** 2 / 2.0 for k, a in amplitudes.items()) * np.sum((t - t.mean()) ** 2)
    return level * rms / (2.0 * pi * np.sqrt(curvature))


@pytest.mark.few(2)
@pytest.mark.parametrize("amplitudes", [SINE, STRONG_HARMONICS, WEAK_FUNDAMENTAL])
@pytest.mark.parametrize("level", [0.04, 0.1])
def test_near_the_least_error_that_is_possible(amplitudes, level):
    random = np.random.default_rng(5)
    errors = []
    for _ in range(60):
        frequency, periods = random.uniform(4.0, 32.0), random.uniform(6.0, 20.0)
        t, signal = record(random, frequency, periods, amplitudes, level)
        found = estimate_frequency(t, signal)
        errors.append((found - frequency) / cramer_rao(periods, frequency, amplitudes, level))
    assert np.sqrt(np.mean(np.square(errors))) < 1.3


@pytest.mark.few(2)
@pytest.mark.parametrize("correlation", [0.0, 0.9])
@pytest.mark.parametrize("amplitudes", [SINE, STRONG_HARMONICS])
def test_standard_errors_are_right_whatever_the_noise(amplitudes, correlation):
    random = np.random.default_rng(6)
    offs, drifts, significant = [], [], 0
    for _ in range(150):
        frequency, periods = random.uniform(4.0, 32.0), random.uniform(6.0, 12.0)
        t, signal = record(random, frequency, periods, amplitudes, 0.07, correlation)
        estimate = estimate_near(t, signal, frequency * random.uniform(0.95, 1.05))
        offs.append((estimate.frequency - frequency) / estimate.std)
        drifts.append(estimate.drift / estimate.drift_std)
        significant += estimate.drifts or estimate.differs(frequency)
    assert np.std(offs) == pytest.approx(1.0, abs=0.25)
    assert np.std(drifts) == pytest.approx(1.0, abs=0.25)
    assert significant == 0


def test_few_cycles_raise_no_false_alarm():
    random = np.random.default_rng(7)
    for _ in range(300):
        t, signal = record(random, 11.0, 4.02, SINE, 0.1, 0.9)
        estimate = estimate_near(t, signal, 11.0)
        assert not estimate.drifts
        assert not estimate.differs(11.0)


@pytest.mark.parametrize("change", [0.01, -0.01])
def test_drift_is_measured_with_its_sign(change):
    random = np.random.default_rng(8)
    t, signal = record(random, 20.0, 20.4, STRONG_HARMONICS, 0.04, change=change)
    found = estimate_near(t, signal, 20.0)
    assert found.drift == pytest.approx(change, abs=4.0 * found.drift_std)
    assert found.drift_std < 1e-3
    assert found.drifts


def test_a_foreign_tone_is_no_drift():
    """A tone next to the input's frequency turns its phase, but not in step with a drift."""
    random = np.random.default_rng(9)
    for phase in np.linspace(0.0, 2.0 * pi, 9):
        t, signal = record(random, 20.0, 8.4, STRONG_HARMONICS, 0.04)
        estimate = estimate_near(t, signal + 0.1 * np.sin(2.0 * pi * 21.3 * t + phase), 20.0)
        assert not estimate.drifts
        assert not estimate.differs(20.0)


def test_many_cycles_correct_a_clock_that_is_off_by_a_little():
    random = np.random.default_rng(12)
    t, signal = record(random, 20.0, 60.3, STRONG_HARMONICS, 0.04)
    found = refined_frequency(t, signal, 20.0 * 1.001)
    assert found == pytest.approx(20.0, abs=5.0 * estimate_near(t, signal, 20.0).std)
    assert refined_frequency(t, signal, 20.0) == 20.0
    assert refined_frequency(t, signal, 20.2) == 20.2  # for the reader to refuse


@pytest.mark.parametrize("cycles", [60.3, 300.3])
def test_rounding_of_a_stated_frequency_is_no_misfit_of_a_long_record(cycles):
    """A turn of 1/50 of a cycle in all, which takes a 10,000th off the fifth harmonic."""
    random = np.random.default_rng(13)
    t, signal = record(random, 20.0, cycles, STRONG_HARMONICS, 0.01)
    stated = 20.0 * (1.0 + 0.019 / cycles)
    assert abs(refined_frequency(t, signal, stated) - 20.0) < 0.2 * abs(stated - 20.0)


def test_half_the_frequency_is_that_of_a_doubled_period_or_a_foreign_tone():
    """Weak lines half way between the harmonics do not make half the frequency the input's."""
    random = np.random.default_rng(13)
    for other, size in ((10.0, 0.05), (10.0, 0.2), (10.4, 0.1)):
        t, signal = record(random, 20.0, 8.4, STRONG_HARMONICS, 0.04)
        assert estimate_frequency(t, signal + size * np.sin(2.0 * pi * other * t)) == pytest.approx(
            20.0, rel=3e-3
        )
    t, signal = record(random, 10.0, 8.4, {1: 0.5, 2: 1.0, 3: 0.2}, 0.04)
    assert estimate_frequency(t, signal) == pytest.approx(10.0, rel=3e-3)


def test_noise_alone_has_no_frequency():
    random = np.random.default_rng(10)
    t = np.arange(2000) / SAMPLING
    found = [estimate_frequency(t, random.normal(size=t.size)) for _ in range(30)]
    assert np.isnan(found).sum() >= 29


def test_only_what_repeats_stands_out():
    t, signal = record(np.random.default_rng(11), 20.0, 10.3, SINE, 0.04)
    assert stands_out(t, signal, 20.0)
    for other in (10.0, 14.0, 40.0):
        assert not stands_out(t, signal, other)


def test_each_harmonic_aligns_by_its_own_order():
    time = np.arange(3000) / 100.0
    x = 0.02 * np.cos(2.0 * np.pi * 2.0 * time) + np.cos(2.0 * np.pi * 6.0 * time + 0.7)
    assert _search(cut(time, x, 2.01), 0.05) == pytest.approx(-0.01, abs=1e-3)
