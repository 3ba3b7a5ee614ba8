"""Noise of a measured force: what a smooth function of the motion cannot explain.

The function knows no mechanics: it is free in the displacement, in the velocity of either sign, in the
acceleration, and in the distance since the last reversal, so that it can take the shape of any friction. What
it leaves is noise, or physics that is none of these; both are told alike, and the spectrum is that of both.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np

from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum, of_noise
from wedgesweep.diagnose.smoothing import LowPass, Motion

FROM_MOTION = "what no smooth function of the motion explains"
# Knots over the displacement and over the velocity of either sign.
PLACES, SPEEDS = 13, 7
# Distances since a reversal over which friction may build up, over the range of the motion.
DISTANCES = (0.003, 0.01, 0.03, 0.1, 0.3)
# Share of singular values below which a combination of functions is left out.
DEPENDENT = 1e-9
# Samples for each function, below which some of them are left out.
ENOUGH = 12
# Compared samples to either side of a reversal that are left out here beyond those that no fit compares: the
# functions jump at samples, and friction between them.
FARTHER = 3
# Part of the record at least that must be free of reversals.
LEAST_CLEAR = 0.2


@dataclass(frozen=True)
class MotionNoise:
    """Force (N) that noise of the displacement, of some ``std`` (m), makes of an ``impedance``.

    The latter holds the force by displacement (N/m), velocity (N s/m) and acceleration (kg). The force has
    passed a filter, of which every so many samples are compared (``low_pass.stride``).
    """

    low_pass: LowPass
    impedance: tuple[float, float, float]
    std: float

    @cached_property
    def _power(self) -> np.ndarray:
        """Power up to half the sampling rate, of all samples."""
        return self.low_pass.power(self.std, self.impedance)

    def power(self, frequency: np.ndarray) -> np.ndarray:
        """Power at frequencies in rad a compared sample."""
        stride = self.low_pass.stride
        grid = np.linspace(0.0, stride * pi, self._power.size)
        return np.interp(frequency, grid, self._power) / stride

    def covariance(self, distance: np.ndarray) -> np.ndarray:
        """Covariance of two compared samples by their distance."""
        values = np.fft.irfft(self._power)[: self._power.size : self.low_pass.stride]
        return np.where(distance < values.size, values[np.minimum(distance, values.size - 1)], 0.0)


def impedance(motion: Motion, force: np.ndarray, mass: float) -> tuple[float, float, float]:
    """Force (n,) by displacement, velocity and acceleration, whatever makes it; dry friction is set apart.

    Damping may differ by direction, and counts by its mean square.
    The acceleration's part is that of the ``mass`` (kg, negative if the force counts the other way), as
    inertia and stiffness look alike in a sine.
    """
    x, v = motion.displacement, motion.velocity
    columns = np.column_stack([x, v, np.abs(v), np.sign(v), np.ones(x.size)])
    size = np.linalg.norm(columns, axis=0)
    fitted = np.linalg.lstsq(columns / size, force - mass * motion.acceleration, rcond=None)[0] / size
    return float(fitted[0]), float(np.hypot(fitted[1], fitted[2])), mass


def of_force(
    motion: Motion, force: np.ndarray, places: np.ndarray, clear: np.ndarray, known: MotionNoise
) -> NoiseSpectrum:
    """The noise of a force (k,) that was filtered, at some places (k,) of a motion.

    ``clear`` (k,): those that are away from reversals, where noise of the motion turns a jump of friction
    into an outlier. ``known``: the noise that comes from that of the motion, which is not counted again.
    """
    clear = np.convolve(clear, np.ones(2 * FARTHER + 1), mode="same") > 2 * FARTHER + 0.5
    columns = known.low_pass(_functions(motion).T)[:, places].T
    columns = columns[:, : max(int(clear.sum()) // ENOUGH, 4)]
    u, size, _ = np.linalg.svd(columns[clear], full_matrices=False)
    basis = u[:, size > DEPENDENT * size[0]]
    left = force[clear] - basis @ (basis.T @ force[clear])
    left *= np.sqrt(left.size / max(left.size - basis.shape[1], 1))
    whole = np.zeros(force.size)
    whole[clear] = left
    # Samples that are left out carry their share of the power.
    share = max(float(clear.mean()), LEAST_CLEAR)
    return of_noise([whole / np.sqrt(share)], FROM_MOTION, known.power)


def _functions(motion: Motion) -> np.ndarray:
    """Functions of the motion, (n, k), the most important ones first."""
    x, a = _scaled(motion.displacement), _scaled(motion.acceleration)
    v = motion.velocity / np.abs(motion.velocity).max()
    sign = np.sign(v)
    simple = [np.ones(x.size), sign, v, x, a, np.linspace(-1.0, 1.0, x.size)]
    since = _since_reversal(motion)
    history = [sign * np.exp(-since / distance) for distance in DISTANCES]
    both = _hats(x, PLACES)
    speeds = _hats(np.abs(v), SPEEDS)
    columns = [*simple, *history, *both, *(each * (v > 0.0) for each in speeds)]
    columns += [*(each * (v < 0.0) for each in speeds), *(each * sign for each in both), np.abs(a)]
    return np.column_stack(columns)


def _scaled(values: np.ndarray) -> np.ndarray:
    """Values (n,) about their middle, over half their range."""
    low, high = values.min(), values.max()
    return (values - 0.5 * (low + high)) / max(0.5 * float(high - low), 1e-300)


def _hats(values: np.ndarray, knots: int) -> list[np.ndarray]:
    """Piecewise linear functions of values (n,), one for each knot."""
    at = np.quantile(values, np.linspace(0.0, 1.0, knots))
    at = np.unique(at)
    return [np.interp(values, at, row) for row in np.eye(at.size)]


def _since_reversal(motion: Motion) -> np.ndarray:
    """Distance (n,) since the last reversal over the range of the motion."""
    x, sign = motion.displacement, np.sign(motion.velocity)
    turns = np.r_[0, np.flatnonzero(np.diff(sign) != 0.0) + 1]
    last = turns[np.searchsorted(turns, np.arange(x.size), side="right") - 1]
    return np.abs(x - x[last]) / max(float(np.ptp(x)), 1e-300)
