"""Power of samples by frequency, under a Hann window."""

import numpy as np


def without_trend(samples: np.ndarray) -> np.ndarray:
    """Samples (n,) less the straight line through them (least squares)."""
    from scipy.signal import detrend

    return np.asarray(detrend(samples))


def power_of(samples: np.ndarray, padded: int = 1) -> np.ndarray:
    """Power (k,) of an orthonormal Fourier coefficient, from frequency 0 to half the sampling rate.

    ``samples`` (n,) have no mean; k = n // 2 + 1, or that of ``padded`` times as many samples.
    """
    from scipy.signal import periodogram

    size = padded * samples.size
    found = periodogram(samples, window="hann", nfft=size, detrend=False, return_onesided=False)[1]
    return np.asarray(found[: size // 2 + 1])
