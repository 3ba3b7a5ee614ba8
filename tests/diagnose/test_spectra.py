"""Harmonics and noise of records whose truth is known."""

from math import pi

import numpy as np
import pytest
from scipy.signal import lfilter

from wedgesweep.diagnose import tone
from wedgesweep.diagnose.spectra import COMPARED, spectrum

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


@pytest.mark.parametrize("correlation", [0.0, 0.9])
@pytest.mark.parametrize("frequency", [5.0, 11.0, 32.0])
def test_whitened_errors_have_unit_variance(frequency, correlation):
    rng = np.random.default_rng(int(frequency) + int(10 * correlation))
    squares = []
    for _ in range(40):
        time, channels, truth = record(rng, frequency, correlation=correlation, slope=0.01)
        found = spectrum(time, channels, frequency)
        squares.append(2.0 * np.abs(found.mean - truth) ** 2 / found.variance)
    per_number = np.mean(squares) / 2.0
    # 40 records of 2 x 16 complex numbers: the mean square is known to 2 %, the noise level to as much.
    assert per_number == pytest.approx(1.0, abs=0.08)


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


def spectra_with(rng, foreign):
    """Spectra of five tests, all with one foreign tone of a given amplitude at 47.3 Hz."""
    spectra = []
    for frequency in (5.0, 8.0, 11.0, 20.0, 32.0):
        time, channels, _ = record(rng, frequency)
        channels = channels + foreign * np.sin(2.0 * pi * 47.3 * time + rng.uniform(0.0, 6.0))
        spectra.append(spectrum(time, channels, frequency))
    return spectra


def test_a_foreign_tone_is_found_where_it_is():
    assert tone.find(spectra_with(np.random.default_rng(3), 0.03)) == pytest.approx(47.3, abs=0.05)


def test_noise_alone_has_no_tone():
    rng = np.random.default_rng(4)
    assert [tone.find(spectra_with(rng, 0.0)) for _ in range(30)] == [None] * 30


def test_subharmonics_of_a_response_are_no_foreign_tone():
    rng = np.random.default_rng(5)
    spectra = []
    for frequency in (5.0, 8.0, 11.0):
        time, channels, _ = record(rng, frequency)
        channels = channels + 0.1 * np.sin(pi * frequency * time)
        spectra.append(spectrum(time, channels, frequency))
    assert tone.find(spectra) is None
