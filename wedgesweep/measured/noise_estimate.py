"""The noise of a channel: the part that is not periodic."""

from dataclasses import dataclass

import numpy as np

from wedgesweep.measured.cycles import cut

HARMONICS = np.arange(1, 41)


@dataclass(frozen=True, eq=False)
class NoiseEstimate:
    """The part of a channel that is not periodic.

    ``std`` is in the channel's unit, ``share`` is relative to the rms of the periodic part; ``residual`` (n,)
    is the channel without its periodic part and its mean.
    """

    std: float
    share: float
    residual: np.ndarray


def estimate_noise(time: np.ndarray, signal: np.ndarray, frequency: float) -> NoiseEstimate:
    """Estimate the noise of a channel, shape (n,), that vibrates at a frequency (Hz)."""
    cycles = cut(time, signal, frequency, HARMONICS)
    mean = cycles.harmonics.mean(axis=0)
    repeated = np.zeros(time.size)
    phase = cycles.omega * (time - cycles.middle)
    for order, harmonic in zip(cycles.orders.tolist(), mean, strict=True):
        repeated += (harmonic * np.exp(1j * order * phase)).real
    left = signal - signal.mean() - (repeated - repeated.mean())
    std = float(np.sqrt(left @ left / (time.size - 2 * mean.size - 1)))
    return NoiseEstimate(std, std / float(repeated.std()), left)
