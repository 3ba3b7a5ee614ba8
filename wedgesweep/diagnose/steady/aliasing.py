"""What a record makes of harmonics above half its sampling rate.

A bolster that sticks and slips has kinks in its motion, and harmonics without end. Sampling shows those above
half its rate at other frequencies; where the rate is nearly a multiple of the input's frequency, these are so
close to the harmonics below that no record tells them apart. (Slip pulses at 31.3 Hz, sampled 63.05 times
a period at 4 % noise: 62 in Q.) A low-pass ahead of the sampling takes them out.
"""

from typing import NamedTuple

import numpy as np


class AliasMap(NamedTuple):
    """Shares (columns, K), complex, of harmonics D_k in what is read: of D_k itself, and of its conjugate."""

    direct: np.ndarray
    mirrored: np.ndarray

    def __call__(self, harmonics: np.ndarray) -> np.ndarray:
        """What is read (..., C, columns) beside themselves for harmonics (..., C, K) at the first sample."""
        return harmonics @ self.direct.T + harmonics.conj() @ self.mirrored.T


def alias_map(inverse: np.ndarray, turns: np.ndarray, removed: int) -> AliasMap:
    """Of a least-squares fit that reads ``inverse @ signal``, shape (columns, n), complex.

    ``turns`` (K, n) are exp(i k omega t) at the samples; the first ``removed`` are part of the fit.
    """
    direct, mirrored = 0.5 * inverse @ turns.T, 0.5 * inverse @ turns.conj().T
    direct[:, :removed] = mirrored[:, :removed] = 0.0
    return AliasMap(direct, mirrored)
