"""Compared forces as combinations that are independent under coloured noise."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag

# Samples in a row whose correlation is known; farther ones count as independent.
MOST = 400


class Decorrelation(NamedTuple):
    """Orthogonal combinations of samples: ``matrix`` (k, k), and the standard deviation (k,) of each."""

    matrix: np.ndarray
    std: np.ndarray


def decorrelation(
    known: np.ndarray, covariance: Callable[[np.ndarray], np.ndarray], least: float
) -> Decorrelation:
    """Combinations of the known samples (k,); those of the others are zero.

    ``covariance`` gives that of two samples by their distance; no variance is less than ``least``.
    """
    size = known.size
    matrix, std = np.zeros((size, size)), np.zeros(size)
    rows = np.flatnonzero(known)
    parts = np.array_split(rows, max(-(-rows.size // MOST), 1)) if rows.size else []
    done = []
    for part in parts:
        distance = np.abs(part[:, None] - part)
        variance, vectors = np.linalg.eigh(covariance(distance))
        done.append((np.sqrt(np.maximum(variance, least)), vectors.T))
    if done:
        std[: rows.size] = np.concatenate([each[0] for each in done])
        matrix[: rows.size, rows] = block_diag(*[each[1] for each in done])
    return Decorrelation(matrix, std)
