"""Noise of sensors and analogue-to-digital converters.

Each kind takes noise-free channels at an even sampling interval and a level: the std of the noise over the
rms of the channel about its mean.
"""

from collections.abc import Callable

import numpy as np

AR1_CORRELATION = 0.9
ADC_CODES = 2**12

Channels = tuple[np.ndarray, np.ndarray]
NoiseKind = Callable[[Channels, float, float, np.random.Generator], Channels]


def of(signal: np.ndarray, level: float, random: np.random.Generator) -> np.ndarray:
    """White noise (n,) of a signal (n,)."""
    return level * signal.std() * random.normal(size=signal.size)


def white(channels: Channels, level: float, step: float, random: np.random.Generator) -> Channels:
    """Independent normal noise on displacement and velocity, shape (n,) each, ``step`` (s) apart."""
    displacement, velocity = (each + of(each, level, random) for each in channels)
    return displacement, velocity


def ar1(channels: Channels, level: float, step: float, random: np.random.Generator) -> Channels:
    """First-order autoregressive noise."""
    displacement, velocity = (each + level * each.std() * _correlated(each.size, random) for each in channels)
    return displacement, velocity


def adc(channels: Channels, level: float, step: float, random: np.random.Generator) -> Channels:
    """White noise of half the level, and a 12-bit converter with the range of the signal."""
    displacement, velocity = map(_quantised, white(channels, 0.5 * level, step, random))
    return displacement, velocity


def differentiated(channels: Channels, level: float, step: float, random: np.random.Generator) -> Channels:
    """White noise on the displacement, and the velocity from its central differences.

    The first and last samples, which have no central difference, are dropped.
    """
    displacement, _ = white(channels, level, step, random)
    return displacement[1:-1], (displacement[2:] - displacement[:-2]) / (2.0 * step)


NOISES: dict[str, NoiseKind] = {"white": white, "ar1": ar1, "adc": adc, "differentiated": differentiated}


def _correlated(count: int, random: np.random.Generator) -> np.ndarray:
    """Stationary autoregressive noise of std 1, shape (count,)."""
    from scipy.signal import lfilter

    fresh = random.normal(size=count)
    fresh[1:] *= np.sqrt(1.0 - AR1_CORRELATION**2)
    return lfilter([1.0], [1.0, -AR1_CORRELATION], fresh)


def _quantised(signal: np.ndarray) -> np.ndarray:
    step = np.ptp(signal) / (ADC_CODES - 1)
    return signal.min() + step * np.rint((signal - signal.min()) / step)
