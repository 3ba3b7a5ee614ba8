"""Noise of a measured force: what a smooth function of the motion cannot explain.

The function knows no mechanics but the force of the model on trial: it is free in the displacement, in the
velocity of either sign, in the acceleration and in springs with sliders (sliders.py). What it leaves is
noise, or physics that is none of these; both are told alike, and the spectrum is that of both.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from wedgesweep.diagnose import sliders
from wedgesweep.diagnose.loop import motion_noise
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum, of_noise
from wedgesweep.diagnose.smoothing import Motion
from wedgesweep.solvers.imposed_motion import reversals, share_jumps

if TYPE_CHECKING:
    from wedgesweep.diagnose.loop.recording import Recording

# Functions (n,) along a motion.
Rows = Sequence[np.ndarray] | np.ndarray

FROM_MOTION = "what no smooth function of the motion explains"
# Knots over the displacement and over the velocity.
PLACES, SPEEDS = 13, 7
# Each so many of the sliders count, but all of them where they leave clearly less, as in an earthquake: under
# simple motions they would only make the estimate of the noise less certain.
COARSE, CLEARLY = 8, 0.5
# Singular value of the functions, over the largest one, below which some of them depend on the others.
DEPENDENT = 1e-6
# Samples for each function, below which some of them are left out.
SAMPLES_PER_FUNCTION = 4
# Variance by noise of the motion, over its median, beyond which a force is too near a reversal.
NEAR = 4.0
# Compared samples to either side of a reversal that are left out as well, as friction may build up there as
# no function does (a carriage on a screw would have 6 % more noise), and the share that must be left then.
FARTHER, ENOUGH_LEFT = 4, 0.5


def of_force(own: "Recording", model: np.ndarray) -> NoiseSpectrum:
    """The noise of the compared force of a test, but for what noise of its motion has passed on.

    ``model`` (n,): the force of a model along the motion.
    """
    clear = _clear(own, own.passed_on[0] + own.white**2)
    filtered = (own.low_pass(np.array(each)) for each in _functions(own.motion, model))
    simple, built_up, smooth = (each[:, own.places].T[clear] for each in filtered)
    few, all_of_them = (
        _left(np.hstack([simple, built_up[:, ::every], smooth]), own.force[clear]) for every in (COARSE, 1)
    )
    whole = np.zeros(own.force.size)
    whole[clear] = all_of_them if all_of_them.std() < CLEARLY * few.std() else few

    def power(frequency: np.ndarray) -> np.ndarray:
        return motion_noise.power(own.passed_on, clear, frequency) + own.white**2

    # Samples that are left out carry their share of the power.
    found = of_noise([whole / np.sqrt(clear.mean())], FROM_MOTION, power)
    return replace(found, white=found.white + own.white**2)


def _clear(own: "Recording", variance: np.ndarray) -> np.ndarray:
    """Samples (k,), of some variance (k,), that are far from reversals, unless few are left then.

    Unless few are left, either, they begin when every slider has slipped, whatever it was at the start.
    """
    quiet = own.known & (variance <= NEAR * np.median(variance[own.known]))
    x = _scaled(own.motion.displacement)
    later = quiet & sliders.known(x, 1.0)[own.places]
    quiet = later if later.sum() >= ENOUGH_LEFT * quiet.sum() else quiet
    turns = np.diff(np.sign(own.motion.velocity[own.places]), append=0.0) != 0.0
    far = quiet & (np.convolve(turns, np.ones(2 * FARTHER + 1), mode="same") < 0.5)
    return far if far.sum() >= ENOUGH_LEFT * quiet.sum() else quiet


def _left(columns: np.ndarray, force: np.ndarray) -> np.ndarray:
    """What columns (n, k) leave of a force (n,): the first ones, as many as the samples can tell apart."""
    columns = columns[:, : max(force.size // SAMPLES_PER_FUNCTION, 1)]
    columns = columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    factors, _, rank, _ = np.linalg.lstsq(columns, force, rcond=DEPENDENT)
    return (force - columns @ factors) * np.sqrt(force.size / (force.size - rank))


def _functions(motion: Motion, model: np.ndarray) -> tuple[Rows, Rows, Rows]:
    """Functions of a motion: simple ones, forces of sliders, smooth ones; jumps count for their share."""
    x, a = _scaled(motion.displacement), _scaled(motion.acceleration)
    v = motion.velocity / np.abs(motion.velocity).max()
    sign = np.sign(v)
    simple = [np.ones(x.size), model, sign, v, x, sign * x, a, np.linspace(-1.0, 1.0, x.size)]
    both = [*_hats(x, PLACES), *_hats(np.abs(v), SPEEDS)]
    smooth, turns = [*both, *(each * sign for each in both)], reversals(motion.velocity)
    for row in (*simple, *smooth):
        share_jumps(row, turns)
    return simple, sliders.forces(x, 1.0), smooth


def _scaled(values: np.ndarray) -> np.ndarray:
    """Values (n,) about their middle, over half their range."""
    low, high = values.min(), values.max()
    return (values - 0.5 * (low + high)) / max(0.5 * float(high - low), 1e-300)


def _hats(values: np.ndarray, knots: int) -> list[np.ndarray]:
    """Piecewise linear functions of values (n,), one for each knot."""
    at = np.quantile(values, np.linspace(0.0, 1.0, knots))
    at = np.unique(at)
    return [np.interp(values, at, row) for row in np.eye(at.size)]
