"""Aliases: what a record shows of harmonics above half its sampling rate.

The motion of a bolster that sticks and slips has kinks, and so harmonics at all orders. Sampling shows those
above half its rate at other frequencies. If the rate is nearly a multiple of the input's frequency, these are
so close to lower harmonics that no record can separate them. (Slip pulses at 31.3 Hz, sampled 63.05 times a
period at 4 % noise: 62 in chi-squared.) A low-pass filter ahead of the sampling removes them.
"""

from typing import NamedTuple

import numpy as np


class AliasMap(NamedTuple):
    """What K harmonics D_k add to the amplitudes that a fit reads.

    ``direct`` and ``mirrored`` (columns, K): complex factors of D_k, and of their conjugates.
    """

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
