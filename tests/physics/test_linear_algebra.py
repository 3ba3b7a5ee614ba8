"""Linear algebra of small matrices against LAPACK."""

import numpy as np
import pytest

from wedgesweep.compiled import compiled
from wedgesweep.solvers import linear_algebra


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
