"""Compared numbers (forces of a loop, coefficients of a transient) as combinations with independent noise."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

# Largest number of samples that are decorrelated together; samples of different blocks count as independent.
LARGEST_BLOCK = 400


class Decorrelation(NamedTuple):
    """Orthogonal combinations of samples: ``matrix`` (k, k), and the standard deviation (k,) of each."""

    matrix: np.ndarray
    std: np.ndarray


def decorrelation(
    known: np.ndarray, covariance: Callable[[np.ndarray], np.ndarray], least: float
) -> Decorrelation:
    """Combinations with independent noise of the samples that are ``known`` (k,), in their places.

    Rows of the matrix and standard deviations are zero where a sample is not known.

    Parameters
    ----------
    known : ndarray of bool, shape (k,)
        Which samples are compared.
    covariance : callable
        Covariance matrix (r, r) of the samples in some rows (r,).
    least : float
        Least variance of a combination.
    """
    matrix, std = np.zeros((known.size, known.size)), np.zeros(known.size)
    rows = np.flatnonzero(known)
    for part in np.array_split(rows, max(-(-rows.size // LARGEST_BLOCK), 1)):
        variance, vectors = np.linalg.eigh(covariance(part))
        std[part] = np.sqrt(np.maximum(variance, least))
        matrix[np.ix_(part, part)] = vectors.T
    return Decorrelation(matrix, std)
