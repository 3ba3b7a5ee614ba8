"""Jumps of an acceleration where dry friction changes its sign.

Their power falls with frequency as that of red noise does, up to the highest frequencies of a record, so that
its noise could not be told from them.
"""

import numpy as np
from scipy.ndimage import median_filter

# Samples over which steps are alike but for noise and jumps; steps that are off by more than so many standard
# deviations belong to a jump.
ALIKE, OFF = 9, 6.0
# Median of the absolute value of a normal variable over its standard deviation.
MEDIAN = 0.6745


def continuous(samples: np.ndarray) -> np.ndarray:
    """Samples (n,) from which jumps are taken."""
    steps = np.diff(samples)
    usual = median_filter(steps, ALIKE, mode="nearest")
    off = np.abs(steps - usual)
    jumps = off > OFF * max(float(np.median(off)) / MEDIAN, 1e-300)
    return samples[0] + np.r_[0.0, np.cumsum(np.where(jumps, usual, steps))]
