"""Compared numbers (forces of a loop, coefficients of a transient) as combinations with independent noise."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

# Samples in a row whose correlation is known; farther ones count as independent.
MOST = 400


class Decorrelation(NamedTuple):
    """Orthogonal combinations of samples: ``matrix`` (k, k), and the standard deviation (k,) of each."""

    matrix: np.ndarray
    std: np.ndarray


def decorrelation(
    known: np.ndarray, covariance: Callable[[np.ndarray], np.ndarray], least: float
) -> Decorrelation:
    """As many combinations of the known samples (k,), in their places; those of the others are zero.

    ``covariance`` gives that of some rows (r,) with one another; no variance is less than ``least``.
    """
    matrix, std = np.zeros((known.size, known.size)), np.zeros(known.size)
    rows = np.flatnonzero(known)
    for part in np.array_split(rows, max(-(-rows.size // MOST), 1)):
        variance, vectors = np.linalg.eigh(covariance(part))
        std[part] = np.sqrt(np.maximum(variance, least))
        matrix[np.ix_(part, part)] = vectors.T
    return Decorrelation(matrix, std)
