"""Aliases: what a record shows of harmonics above half its sampling rate.

A bolster that sticks and slips has kinks in its motion, and harmonics without end. Sampling shows those
above half its rate at other frequencies; if the rate is nearly a multiple of the input's frequency, these
are so close to lower harmonics that no record can separate them. (Slip pulses at 31.3 Hz, sampled 63.05
times a period at 4 % noise: 62 in chi-squared.) A low-pass filter ahead of the sampling removes them.
"""

from typing import NamedTuple

import numpy as np


class AliasMap(NamedTuple):
    """Complex factors (columns, K) of harmonics D_k, and of their conjugates, in what is read."""

    direct: np.ndarray
    mirrored: np.ndarray

    def __call__(self, harmonics: np.ndarray) -> np.ndarray:
        """What harmonics (..., C, K) at the first sample add to those that are read (..., C, columns)."""
        return harmonics @ self.direct.T + harmonics.conj() @ self.mirrored.T


def alias_map(inverse: np.ndarray, phasors: np.ndarray, removed: int) -> AliasMap:
    """Aliases of a least-squares fit that reads ``inverse @ signal``.

    Parameters
    ----------
    inverse : ndarray, shape (columns, n)
        Complex matrix that reads the harmonics from n samples.
    phasors : ndarray, shape (K, n)
        exp(i k omega t) at the samples.
    removed : int
        Number of harmonics that are part of the fit, and so have no aliases.
    """
    direct, mirrored = 0.5 * inverse @ phasors.T, 0.5 * inverse @ phasors.conj().T
    direct[:, :removed] = mirrored[:, :removed] = 0.0
    return AliasMap(direct, mirrored)
