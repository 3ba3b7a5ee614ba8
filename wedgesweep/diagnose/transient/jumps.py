"""Jumps of an acceleration where dry friction changes its sign.

Their power falls with frequency as that of red noise does, up to the highest frequencies of a record: left
in, they would be taken for noise.
"""

import numpy as np
from scipy.ndimage import median_filter

from wedgesweep.diagnose.smoothing import MEDIAN

# A step from one sample to the next is compared with the median of this many steps around it. It belongs to a
# jump if it is off by more than so many standard deviations.
AROUND, OFF = 9, 6.0


def continuous(samples: np.ndarray) -> np.ndarray:
    """Samples (n,) without their jumps: each step of a jump is replaced by the usual one there."""
    steps = np.diff(samples)
    usual = median_filter(steps, AROUND, mode="nearest")
    off = np.abs(steps - usual)
    jumps = off > OFF * max(float(np.median(off)) / MEDIAN, 1e-300)
    return samples[0] + np.r_[0.0, np.cumsum(np.where(jumps, usual, steps))]
