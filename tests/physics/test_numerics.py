"""Small matrices, Fourier series, sines and slopes against NumPy and LAPACK."""

from math import pi

import numpy as np
import pytest

from wedgesweep.compiled import compiled
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.vectors import vector
from wedgesweep.response import fourier
from wedgesweep.sampled_input import from_samples, set_sampled
from wedgesweep.solvers import implicit, linear_algebra
from wedgesweep.systems import compact
from wedgesweep.systems.suspension import parameters
from wedgesweep.trigonometry import cosine, sine


@compiled
def inverted(matrix):
    return linear_algebra.inverted(matrix)


@compiled
def spectral_radius(matrix):
    return linear_algebra.spectral_radius(matrix)


@pytest.mark.parametrize("n", [1, 2, 3, 8])
def test_inverse_and_spectral_radius(n):
    for seed in range(20):
        matrix = np.random.default_rng(seed).normal(size=(n, n))
        np.testing.assert_allclose(inverted(matrix.copy()) @ matrix, np.eye(n), atol=1e-10)
        assert spectral_radius(matrix) == pytest.approx(np.abs(np.linalg.eigvals(matrix)).max(), rel=1e-7)


def test_pivots_that_are_zero():
    swap = np.array([[0.0, 1.0], [1.0, 0.0]])
    assert (inverted(swap.copy()) == swap).all()
    assert not np.isfinite(inverted(np.ones((2, 2)))).all()


def test_spectral_radius_of_matrices_without_a_basis_of_eigenvectors():
    assert spectral_radius(np.diag([1.0, 1.0], k=1)) == 0.0
    defective = 0.9999 * np.eye(4) + np.diag([5.0, 5.0, 5.0], k=1)
    assert spectral_radius(defective) == pytest.approx(0.9999, abs=1e-6)
    # All of the size of what doubles could not hold after 2^32 powers.
    assert spectral_radius(1e9 * np.eye(3)) == pytest.approx(1e9)


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


AMPLITUDE, OMEGA, STEP = 1e-3, 2.0 * pi * 5.0, 2e-3
FRICTIONLESS = {"dynamic": 0.0, "static": 0.0}


@compiled
def by_time(t, cases):
    """Derivative of the rate of a bolster at rest."""
    p = cases[0]
    y = vector(np.zeros(len(interface.scales(p))), interface.scales(p))
    mode = interface.initial_mode(t, y, p)[0]
    return implicit._derivatives(t, y, interface.rate(t, y, mode, p)[0], mode, p)[1]


@pytest.mark.acceptance
@pytest.mark.parametrize("seconds", [4.0, 2000.0])
def test_the_rate_changes_with_the_third_derivative_of_the_base(seconds):
    samples = AMPLITUDE * np.sin(OMEGA * np.arange(0.0, seconds, STEP))
    effects = {"presliding": {"length": 1e-4}}
    case = parameters.record("static-dynamic", AMPLITUDE, OMEGA, {}, FRICTIONLESS, effects)
    given = from_samples(samples, STEP, "displacement")
    set_sampled(case, given, AMPLITUDE, OMEGA, seconds)
    t, moment = 1.0123, 1e-5
    # Without friction masses alone decide how much of the base's acceleration drives the bolster.
    share = parameters.driven_mass(case)[0] / parameters.moving_mass(case)[0]
    expected = share * np.diff(given(np.array([t - moment, t + moment]), 2))[0] / (2.0 * moment)
    assert by_time(t, compact(case))[1] == pytest.approx(-expected, rel=1e-4)
