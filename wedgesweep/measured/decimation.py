"""Shorter records: a low-pass filter and fewer samples or, where these would be too few, a part of them."""

from collections.abc import Mapping
from math import isfinite

import numpy as np

# Samples per period that must remain, so that all harmonics that are compared pass the filter unchanged.
FEWEST_PER_PERIOD = 200
# Half length of the filter in samples that remain, edge of its pass band over the new Nyquist frequency, and
# beta of its Kaiser window: stop band and ripple of -118 dB (Oppenheim and Schafer, Discrete-Time Signal
# Processing, sec. 7.5).
HALF_LENGTH, EDGE, BETA = 20, 0.8, 12.0


def shortened(
    columns: Mapping[str, np.ndarray], time: np.ndarray, frequency: float, most: int
) -> tuple[dict[str, np.ndarray], np.ndarray, str]:
    """Shorten records that vibrate at a frequency, in cycles per unit of time.

    Parameters
    ----------
    columns : mapping of arrays, shape (n,)
        Channels over an even ``time``, shape (n,).
    frequency : float
        Frequency of the vibration; NaN if it is not known.
    most : int
        Number of samples that may remain.

    Returns
    -------
    dict, array, str
        Shorter channels, their times, and what was done in words.
    """
    factor = -(-time.size // most)
    rate = (time.size - 1) / (time[-1] - time[0])
    if not isfinite(frequency) or rate / factor < FEWEST_PER_PERIOD * frequency:
        remark = f"cut to the first {most} of {time.size} samples"
        return {name: samples[:most] for name, samples in columns.items()}, time[:most], remark
    kept = slice(HALF_LENGTH, -HALF_LENGTH)
    thinned = {name: _decimated(samples, factor)[kept] for name, samples in columns.items()}
    remark = f"low-passed and decimated from {time.size} samples to one in {factor}"
    return thinned, time[::factor][kept], remark


def _decimated(samples: np.ndarray, factor: int) -> np.ndarray:
    from scipy.signal import firwin, resample_poly

    taps = firwin(2 * HALF_LENGTH * factor + 1, EDGE / factor, window=("kaiser", BETA))
    mean = samples.mean()
    return resample_poly(samples - mean, 1, factor, window=taps) + mean
