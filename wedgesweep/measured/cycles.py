"""Harmonics of each cycle of a record, and its noise: the part that is not periodic."""

from dataclasses import dataclass
from math import pi

import numpy as np

FIRST_HARMONICS = np.arange(1, 13)
# Those that are no noise.
PERIODIC = np.arange(1, 41)
# A harmonic is detected if its squared mean exceeds this many times the variance of the mean.
SEEN = 15.0


@dataclass(frozen=True, eq=False)
class Cycles:
    """Harmonics of P cycles; the coefficients D of y = Re sum_k D_k exp(i k omega (t - middle)).

    ``times`` (s), shape (P,), are the middles of the cycles, counted from ``middle`` (s) of the record;
    ``harmonics``, shape (P, K), of the given ``orders``, shape (K,), are fitted to each cycle separately,
    together with a constant, ``means``, shape (P,).
    """

    omega: float
    middle: float
    times: np.ndarray
    orders: np.ndarray
    harmonics: np.ndarray
    means: np.ndarray


def cut(
    time: np.ndarray, signal: np.ndarray, frequency: float, orders: np.ndarray = FIRST_HARMONICS
) -> Cycles:
    """Cut a record, shape (n,), into cycles of a frequency (Hz), without orders that are too high to fit.

    Cycles are a little longer than a period, so that they use the whole record; the least-squares fit
    does not need whole periods (Pintelon and Schoukens, System Identification, 2012, ch. 13).
    """
    step = (time[-1] - time[0]) / (time.size - 1)
    count = max(int(time.size * step * frequency * (1.0 + 1e-6)), 1)
    length = time.size // count
    first = (time.size - count * length) // 2
    omega = 2.0 * pi * frequency
    local = step * (np.arange(length) - 0.5 * (length - 1))
    orders = orders[orders <= max(1, (length - 1) // 3)]
    waves = np.exp(1j * omega * np.outer(local, orders))
    design = np.hstack([np.ones((length, 1)), waves.real, -waves.imag])
    blocks = signal[first : first + count * length].reshape(count, length)
    # The waves are almost orthogonal, so that the normal equations are well conditioned.
    fitted = np.linalg.solve(design.T @ design, design.T @ (blocks - signal.mean()).T).T
    here = fitted[:, 1 : orders.size + 1] + 1j * fitted[:, orders.size + 1 :]
    times = step * length * (np.arange(count) - 0.5 * (count - 1))
    middle = float(time[0] + step * (first + 0.5 * (count * length - 1)))
    turned = here * np.exp(-1j * omega * np.outer(times, orders))
    return Cycles(omega, middle, times, orders, turned, signal.mean() + fitted[:, 0])


def slope_of_means(time: np.ndarray, signal: np.ndarray, frequency: float) -> float:
    """Slope of the straight line through the means of the cycles of a frequency (Hz), per unit of time.

    A line through the samples would take a part of the vibration with it, unless its periods are whole.
    """
    cycles = cut(time, signal, frequency, FIRST_HARMONICS)
    about = cycles.times - cycles.times.mean()
    return float(about @ cycles.means / (about @ about))


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
    cycles = cut(time, signal, frequency, PERIODIC)
    mean = cycles.harmonics.mean(axis=0)
    repeated = np.zeros(time.size)
    phase = cycles.omega * (time - cycles.middle)
    for order, harmonic in zip(cycles.orders.tolist(), mean, strict=True):
        repeated += (harmonic * np.exp(1j * order * phase)).real
    left = signal - signal.mean() - (repeated - repeated.mean())
    std = float(np.sqrt(left @ left / (time.size - 2 * mean.size - 1)))
    return NoiseEstimate(std, std / float(repeated.std()), left)
