"""What noise of the recorded displacement does to the simulated force, at each of the compared samples.

An error of the motion makes an error of the force by its displacement, its velocity and its acceleration.
Where the velocity changes its sign dry friction jumps: an error of the velocity moves the jump to another
time. That is an error of the force, too, of twice the friction for as long as the jump is misplaced, and it
is by far the largest one. The filter spreads it over neighbours, whose errors are therefore correlated.

Within one sample nobody knows when a recorded jump took place: a force that was not averaged over each sample
is off by as much as if the jump were anywhere within it. It may be the sample before the jump that is off, or
the one after it.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np
from scipy import fft
from scipy.ndimage import maximum_filter1d

from wedgesweep.diagnose.smoothing import WIDER, LowPass, unlike_steps

# Support of the errors that reach a compared force, over the settling of its filter to one side.
SUPPORT = 3.2
# Steps of the force in a row that are alike but for jumps, and those over which a jump may be spread.
ALIKE, SHARED = 5, 3


class Derivatives(NamedTuple):
    """Derivatives of a force along a motion, (n,) each.

    ``by_motion``: by displacement (N/m), velocity (N s/m) and acceleration (kg), each over as much as noise
    changes it; ``jumps`` (N): by how much it jumps before the next sample, else 0.
    """

    by_motion: tuple[np.ndarray, np.ndarray, np.ndarray]
    jumps: np.ndarray


def jumps(force: np.ndarray) -> np.ndarray:
    """Jumps (N) of a force (n,) before the next sample, else 0: steps unlike those around them.

    A jump may be shared by two samples, and so be in up to three steps.
    """
    unlike = unlike_steps(force, ALIKE)
    size = np.abs(unlike)
    largest = (size > 0.0) & (size >= maximum_filter1d(size, SHARED))
    return np.r_[np.where(largest, np.abs(np.convolve(unlike, np.ones(SHARED), mode="same")), 0.0), 0.0]


def covariance(low_pass: LowPass, places: np.ndarray, std: float, derivatives: Derivatives) -> np.ndarray:
    """Covariance of filtered forces at k lags, (L, k).

    Parameters
    ----------
    low_pass : LowPass
        The filter.
    places : ndarray, shape (k,)
        Samples at which forces are compared, at even distances.
    std : float
        Standard deviation (m) of white noise of the displacement.
    derivatives : Derivatives
        Of the force before the filter.
    """
    step = int(places[1] - places[0]) if places.size > 1 else 1
    size = fft.next_fast_len(int(SUPPORT * low_pass.settling) + 1, real=True)
    around = np.arange(size) - size // 2
    inside = np.abs(around) <= low_pass.settling
    kernel = np.where(inside, np.roll(np.fft.irfft(low_pass.gain(size), size), size // 2), 0.0)

    def seen(values: np.ndarray) -> np.ndarray:
        """Values (n,) around each place, as the filter weighs them, (k, size)."""
        at = places[:, None] + around
        there = (at >= 0) & (at < values.size)
        return np.where(there, values[np.clip(at, 0, values.size - 1)], 0.0) * kernel

    rate = 2j * np.pi * np.fft.rfftfreq(size) * low_pass.rate
    by_motion = (np.fft.rfft(seen(each), axis=1) for each in derivatives.by_motion)
    # Summed by parts: what acts on a derivative of the noise acts on the noise as minus its own derivative.
    through = sum(each * (-rate) ** order for order, each in enumerate(by_motion))
    wide = LowPass(WIDER * low_pass.cutoff, low_pass.rate)
    by_noise = std * np.fft.irfft(through * wide.gain(size), size, axis=1)
    either = np.hypot(derivatives.jumps, np.r_[0.0, derivatives.jumps[:-1]]) / sqrt(12.0)
    return _by_distance(by_noise, step) + _by_distance(seen(either), step)


def _by_distance(weights: np.ndarray, step: int) -> np.ndarray:
    """Sums of products (L, k) of the weights (k, size) that independent errors have at each place."""
    count, size = weights.shape
    found = np.zeros((size // step + 1, count))
    for later in range(min(len(found), count)):
        moved = later * step
        pairs = weights[: count - later, moved:], weights[later:, : size - moved]
        found[later, : count - later] = np.einsum("ij,ij->i", *pairs)
    return found


def between(bands: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Covariance (r, r) of some of the forces, from that of each with those that follow."""
    distance = np.abs(rows[:, None] - rows)
    first = np.minimum(rows[:, None], rows)
    return np.where(distance < len(bands), bands[np.minimum(distance, len(bands) - 1), first], 0.0)


def power(bands: np.ndarray, counted: np.ndarray, frequency: np.ndarray) -> np.ndarray:
    """Mean power at frequencies (rad a compared sample) of the forces that are ``counted`` (k,)."""
    both = [
        float(own[: counted.size - later] @ (counted[: counted.size - later] & counted[later:]))
        for later, own in enumerate(bands[: counted.size])
    ]
    mean = np.array(both) / max(int(counted.sum()), 1)
    found = mean[0] + 2.0 * np.cos(np.outer(frequency, np.arange(1, mean.size))) @ mean[1:]
    return np.maximum(found, 0.0)
