"""Harmonics of sampled signals, against a fast Fourier transform."""

import numpy as np
import pytest

from wedgesweep.compiled import compiled
from wedgesweep.response import fourier


@compiled
def harmonics(first, second, out):
    fourier(first, second, out)


@pytest.mark.parametrize("samples", [1, 2, 7, 8, 63, 64])
def test_harmonics_are_those_of_the_fast_transform(samples):
    signals = np.random.default_rng(0).normal(size=(2, samples))
    out = np.empty((2, 9, 2))
    harmonics(*signals, out)
    orders = np.arange(1, 10)
    # Beyond half the sampling rate they are those of the alias.
    expected = 2.0 * np.fft.fft(signals)[:, orders % samples] / samples
    assert out[..., 0] + 1j * out[..., 1] == pytest.approx(expected, abs=1e-13)
