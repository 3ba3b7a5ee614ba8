"""Sine and cosine that need no calls."""

import numpy as np
import pytest

from wedgesweep.compiled import compiled
from wedgesweep.trigonometry import cosine, sine


@compiled
def _both(x, out):
    for i in range(x.size):
        out[0, i], out[1, i] = sine(x[i]), cosine(x[i])


@pytest.mark.parametrize("largest", [1e-8, 1.0, 7.0, 1e6])
def test_both_are_those_of_the_library_to_two_units_of_the_last_place(largest):
    x = np.linspace(-largest, largest, 100_001)
    out = np.empty((2, x.size))
    _both(x, out)
    np.testing.assert_allclose(out, [np.sin(x), np.cos(x)], rtol=4.4e-16, atol=0.0)


def test_multiples_of_a_right_angle():
    x = np.pi / 2 * np.arange(-1000, 1001)
    out = np.empty((2, x.size))
    _both(x, out)
    # Absolute: near zero numpy and this series see the same rounding error of the angle.
    np.testing.assert_allclose(out, [np.sin(x), np.cos(x)], rtol=4.4e-16, atol=1e-28)


def test_what_is_not_a_number_stays_so():
    out = np.empty((2, 3))
    _both(np.array([np.nan, np.inf, -np.inf]), out)
    assert np.isnan(out).all()
