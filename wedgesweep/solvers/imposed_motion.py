"""The force that a motion takes which is imposed on the mass: no equation of motion is left to solve.

States of effects (bristles, time at rest) follow the motion. Each is integrated by the exponential Euler
method, which is exact for a rate that is linear in its state, however stiff (Hochbruck and Ostermann, 2010,
"Exponential integrators"). What moves freely between two ends moves exactly.
"""

from math import expm1, isnan, nan

import numpy as np

from wedgesweep.compiled import compiled, inner
from wedgesweep.hybrid.interface import (
    already_moving,
    driving_force,
    initial_mode,
    moved_freely,
    rate,
    scales,
    share_before_jump,
)
from wedgesweep.hybrid.vectors import replaced, vector
from wedgesweep.systems import grouped

# Parts of a sample over which the force is averaged where regularised friction runs through its ramp.
PARTS = 16
# States of the mass itself, which the motion gives, and the step of the others for their derivatives.
GIVEN, DIFFERENCE = 2, 1e-6


def forces(
    parameters: np.ndarray,
    displacement: np.ndarray,
    velocity: np.ndarray,
    acceleration: np.ndarray,
    step: float,
) -> np.ndarray:
    """Force on the mass along a motion: the mean over each sample where friction changes within it.

    Parameters
    ----------
    parameters : structured array, shape (n,)
        Cases; see systems.suspension.parameters.record.
    displacement : ndarray, shape (k,) or (n, k)
        Displacement of the mass as the system holds it (m), at even times, which may differ between cases.
    velocity, acceleration : ndarray, shape (k,)
        Its derivatives (m/s, m/s^2).
    step : float
        Time (s) between them.

    Returns
    -------
    ndarray, shape (n, k)
        Forces (N); NaN where they are not determined: at rest under set-valued friction, or beyond lift-off.
    """
    found = np.empty((len(parameters), velocity.size))
    places = np.broadcast_to(displacement, found.shape)
    motion, turns = np.stack([velocity, acceleration]), reversals(velocity)
    for rows, cases in grouped(parameters):
        part = np.empty((rows.size, velocity.size))
        _follow_all(cases, places[rows], motion, turns, step, part)
        found[rows] = part
    return found


def reversals(velocity: np.ndarray) -> np.ndarray:
    """Share of the interval after each sample (k,) but the last at which a velocity reverses, else NaN."""
    before, after = velocity[:-1], velocity[1:]
    turning = before * after < 0.0
    return np.divide(before, before - after, out=np.full(before.size, np.nan), where=turning)


@compiled
def share_jumps(force, shares):
    """Let jumps of a force (k,) between two samples count for their share of the interval, in place.

    ``shares`` (k - 1,): of each interval, after which the force jumps; NaN: it does not. Otherwise the time
    of each jump would be rounded to the grid.
    """
    jump = np.diff(force)
    for i in range(jump.size):
        late = shares[i] - 0.5
        if late < 0.0:
            force[i] -= late * jump[i]
        elif late > 0.0:
            force[i + 1] -= late * jump[i]


@compiled
def _follow_all(cases, places, motion, turns, step, out):
    shares = np.empty(turns.size)
    for k in range(cases.size):
        p = cases[k]
        y = replaced(vector(np.zeros(len(scales(p))), scales(p)), 1, motion[0, 0])
        y = already_moving(y, p)
        # Regularised friction does not jump where the velocity reverses.
        jumps = 1.0 if p.friction.set_valued else nan
        for i in range(motion.shape[1]):
            y = replaced(replaced(y, 0, places[k, i]), 1, motion[0, i])
            out[k, i] = _force(y, motion[1, i], step, p)
            following = min(i + 1, motion.shape[1] - 1)
            # States of effects see the mean motion between two samples.
            y = replaced(y, 0, 0.5 * (places[k, i] + places[k, following]))
            y = replaced(y, 1, 0.5 * (motion[0, i] + motion[0, following]))
            if i < turns.size:
                shares[i] = share_before_jump(y, step, p) if isnan(turns[i]) else jumps * turns[i]
            y = moved_freely(y, _advanced(y, step, p), step, p)
        share_jumps(out[k], shares)


@inner
def _force(y, acceleration, step, p):
    """Force at a sample, whose velocity changes evenly from half a step before it to half a step after it."""
    # Beyond this velocity friction neither changes its sign within the sample nor leaves its ramp.
    slow = abs(y[1]) < p.friction.v_t + 0.5 * abs(acceleration) * step
    parts = PARTS if slow and not p.friction.set_valued else 1
    total = 0.0
    for part in range(parts):
        later = ((part + 0.5) / parts - 0.5) * step
        there = replaced(y, 0, y[0] + (y[1] + 0.5 * acceleration * later) * later)
        there = replaced(there, 1, y[1] + acceleration * later)
        total += driving_force(0.0, acceleration, there, initial_mode(0.0, there, p)[0], p)
    return total / parts


@inner
def _advanced(y, step, p):
    """The state vector with the effects' own states after a step."""
    mode = initial_mode(0.0, y, p)[0]
    now, size = rate(0.0, y, mode, p)[0], scales(p)
    following = y
    for place in range(GIVEN, len(y)):
        moved = DIFFERENCE * size[place]
        beside = rate(0.0, replaced(y, place, y[place] + moved), mode, p)[0]
        growth = step * (beside[place] - now[place]) / moved
        share = expm1(growth) / growth if growth != 0.0 else 1.0
        following = replaced(following, place, y[place] + step * share * now[place])
    return following
