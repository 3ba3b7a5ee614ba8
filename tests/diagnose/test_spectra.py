"""Harmonics and noise of records whose truth is known."""

from math import pi

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import gamma

from wedgesweep.diagnose.steady import tone
from wedgesweep.diagnose.steady.harmonic_fit import COMPARED
from wedgesweep.diagnose.steady.spectra import spectrum

RATE = 2000.0


def coloured(rng, samples, correlation, level):
    """AR(1) noise of the given standard deviation, shape (samples,)."""
    return (
        level * np.sqrt(1.0 - correlation**2) * lfilter([1.0], [1.0, -correlation], rng.normal(size=samples))
    )


def record(rng, frequency, periods=8.4, correlation=0.0, level=0.04, slope=0.0):
    """Time, two channels and the true harmonics (2, COMPARED) of one test."""
    time = np.arange(int(periods / frequency * RATE)) / RATE
    orders = np.arange(1, COMPARED + 1)
    truth = rng.normal(size=(2, COMPARED, 2)) @ [1.0, 1j] / orders**2
    turns = np.exp(2j * pi * frequency * np.outer(orders, time))
    noise = np.array([coloured(rng, time.size, correlation, level) for _ in range(2)])
    return time, (truth @ turns).real + noise + 3.0 + slope * time, truth


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("frequency", "periods", "correlation"),
    [(11.0, 4.0, 0.9), (5.0, 8.4, 0.9), (32.0, 8.4, 0.0), (11.0, 8.4, 0.9), (11.0, 4.5, 0.0)],
)
def test_whitened_errors_have_unit_variance(frequency, periods, correlation):
    """In short records, too, in which the harmonics take some of the noise between them with them."""
    rng = np.random.default_rng([int(frequency), int(10 * correlation), int(10 * periods)])
    squares = []
    for _ in range(200):
        time, channels, truth = record(rng, frequency, periods, correlation, slope=0.01)
        found = spectrum(time, channels, frequency)
        squares.append(np.abs(found.mean - truth) ** 2 / found.variance)
    per_harmonic = np.mean(squares, axis=(0, 1))
    # The mean square of 200 records of 2 x 16 complex numbers is known to 1.3 %.
    assert per_harmonic.mean() == pytest.approx(1.0, abs=0.04)
    # At either end of the band the noise level is known least: means over three harmonics, known to 3 %.
    assert per_harmonic[:3].mean() == pytest.approx(1.0, abs=0.09)
    assert per_harmonic[-3:].mean() == pytest.approx(1.0, abs=0.09)


def test_common_noise_of_two_channels_is_found():
    rng = np.random.default_rng(1)
    time, channels, _ = record(rng, 11.0)
    extra = 0.08 * rng.normal(size=time.size)
    found = spectrum(time, channels + extra, 11.0)
    expected = 0.08**2 / (0.08**2 + 0.04**2)
    assert found.coherence.real == pytest.approx(expected, abs=0.1)


def test_a_second_channel_that_says_nothing_new_is_dropped():
    rng = np.random.default_rng(2)
    time, channels, _ = record(rng, 11.0)
    found = spectrum(time, np.array([channels[0], 2.0 * channels[0]]), 11.0)
    assert found.mean.shape[0] == 1


def spectra_with(rng, amplitude, line=0.0):
    """Spectra of five tests, all with one spurious tone of a given amplitude at 47.3 Hz.

    ``line``: amplitude of a line at 16.7 Hz that the last test alone has.
    """
    spectra = []
    for frequency in (5.0, 8.0, 11.0, 20.0, 32.0):
        time, channels, _ = record(rng, frequency)
        channels = channels + amplitude * np.sin(2.0 * pi * 47.3 * time + rng.uniform(0.0, 6.0))
        channels += (frequency == 32.0) * line * np.sin(2.0 * pi * 16.7 * time)
        spectra.append(spectrum(time, channels, frequency))
    return spectra


@pytest.mark.parametrize("amplitude", [0.03, 0.3, 3.0])
def test_a_spurious_tone_is_found_where_it_is(amplitude):
    found = tone.find(spectra_with(np.random.default_rng(3), amplitude))
    assert found.frequency == pytest.approx(47.3, abs=0.05)
    assert abs(found.frequency - 47.3) < 4.0 * found.std


def test_lines_of_one_response_alone_neither_hide_a_tone_nor_are_one():
    found = tone.find(spectra_with(np.random.default_rng(4), 0.03, line=1.0))
    assert found.frequency == pytest.approx(47.3, abs=0.1)
    assert [tone.find(spectra_with(np.random.default_rng(seed), 0.0, line=1.0)) for seed in range(12)] == [
        None
    ] * 12


@pytest.mark.acceptance
def test_the_frequency_of_a_tone_is_as_uncertain_as_it_says():
    found = [tone.find(spectra_with(np.random.default_rng(seed), 0.05)) for seed in range(16)]
    pulls = np.array([(each.frequency - 47.3) / each.std for each in found])
    assert 0.7 < np.sqrt((pulls**2).mean()) < 1.4


def test_the_chance_of_a_tone_is_exact_and_never_ends():
    power, count = np.array([0.5, 30.0, 40.0, 5000.0]), np.array([1, 24, 6, 24])
    np.testing.assert_allclose(
        tone.log_p_value(power[:3], count[:3]), gamma.logsf(power[:3], count[:3]), rtol=1e-10
    )
    assert -5000.0 < tone.log_p_value(power, count)[3] < -4700.0


def test_a_tone_beside_a_harmonic_leaves_the_others_alone():
    """24 Hz: the record cannot tell a tone at 47.3 Hz from the second harmonic."""
    rng, squares = np.random.default_rng(6), []
    for _ in range(40):
        time, channels, truth = record(rng, 24.0)
        spurious = 0.1 * np.sin(2.0 * pi * 47.3 * time + rng.uniform(0.0, 6.0))
        found = spectrum(time, channels + spurious, 24.0, 47.3)
        assert (found.tone, found.masked_harmonic, found.observations) == (None, 2, 4 * (COMPARED - 1))
        squares.append(2.0 * np.abs(found.mean - truth) ** 2 / found.variance)
    others = np.delete(np.array(squares), 1, axis=2)
    assert others.mean() == pytest.approx(2.0, rel=0.1)


@pytest.mark.acceptance
def test_noise_alone_has_no_tone():
    rng = np.random.default_rng(4)
    assert [tone.find(spectra_with(rng, 0.0)) for _ in range(30)] == [None] * 30


@pytest.mark.parametrize("frequencies", [(5.0, 8.0, 11.0, 11.0), (11.0, 11.0, 11.0)])
def test_subharmonics_of_a_response_are_no_spurious_tone(frequencies):
    rng = np.random.default_rng(5)
    spectra = []
    for frequency in frequencies:
        time, channels, _ = record(rng, frequency)
        channels = channels + 0.1 * np.sin(pi * frequency * time)
        spectra.append(spectrum(time, channels, frequency))
    assert tone.find(spectra) is None


def test_lines_of_a_doubled_period_are_neither_noise_nor_harmonics():
    rng, squares = np.random.default_rng(7), []
    for _ in range(20):
        time, channels, truth = record(rng, 5.0)
        odd = np.arange(1, 12, 2)[:, None]
        halves = np.cos(pi * 5.0 * odd * time + rng.uniform(0.0, 6.0, odd.shape)).sum(axis=0)
        found = spectrum(time, channels + 0.05 * halves, 5.0)
        squares.append(2.0 * np.abs(found.mean - truth) ** 2 / found.variance)
    assert np.mean(squares) == pytest.approx(2.0, rel=0.08)


def test_lines_of_a_doubled_period_are_no_coherence_of_the_noise():
    """They are the same motion in both channels, and stronger in the velocity."""
    rng = np.random.default_rng(8)
    for _ in range(10):
        time, channels, _ = record(rng, 5.0)
        halves = np.exp(1j * pi * 5.0 * np.arange(1, 8, 2)[:, None] * time).sum(axis=0)
        found = spectrum(time, channels + 0.003 * np.array([halves.real, -60.0 * halves.imag]), 5.0)
        assert found.mean.shape[0] == 2
        assert abs(found.coherence) < 0.4


@pytest.mark.acceptance
def test_a_tone_is_not_drawn_to_where_a_record_begins_to_tell_it_from_a_harmonic():
    """The record at 24 Hz, which shows most of it, tells it from 72 Hz from 75.4 Hz on."""
    for seed in range(20):
        rng, spectra = np.random.default_rng(seed), []
        for frequency, size in ((5.0, 0.0), (11.0, 0.0), (20.0, 0.02), (24.0, 0.04), (32.0, 0.02)):
            time, channels, _ = record(rng, frequency)
            spurious = size * np.sin(2.0 * pi * 74.2 * time + rng.uniform(0.0, 6.0))
            spectra.append(spectrum(time, channels + spurious, frequency))
        found = tone.find(spectra)
        assert abs(found.frequency - 74.2) < 4.5 * found.std


def test_a_slow_record_does_not_hide_a_tone_from_the_others():
    """Sampled at 50 Hz it shows nothing beyond 20 Hz; alone, at 2 Hz, there is nothing to look at."""
    spectra = spectra_with(np.random.default_rng(3), 0.3)
    time = np.arange(105) / 50.0
    slow = np.sin(2.0 * pi * 4.0 * time) + 0.04 * np.random.default_rng(1).normal(size=time.size)
    found = tone.find([*spectra, spectrum(time, slow[None], 4.0)])
    assert found.frequency == pytest.approx(47.3, abs=0.05)
    assert tone.find([spectrum(25.0 * time, slow[None], 4.0 / 25.0)]) is None
