"""The force that a motion takes which is imposed on the mass: no equation of motion is left to solve.

States of effects (bristles, time at rest) follow the motion. Each is integrated by the exponential Euler
method, which is exact for a rate that is linear in its state, however stiff (Hochbruck and Ostermann, 2010,
"Exponential integrators"). The rod of a damper moves freely in its play, exactly.
"""

from math import expm1

import numpy as np

from wedgesweep.compiled import compiled, inner
from wedgesweep.effects import damper_play
from wedgesweep.hybrid.interface import driving_force, initial_mode, rate, scales
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
    motion = np.stack([velocity, acceleration])
    for rows, cases in grouped(parameters):
        found[rows] = _with_all_jumps(cases, *_followed(cases, places[rows], motion, step), velocity)
    return found


def _followed(
    cases: np.ndarray, places: np.ndarray, motion: np.ndarray, step: float
) -> tuple[np.ndarray, np.ndarray]:
    """Forces (n, k) at the samples, and the share of the interval after each at which a rod begins to press.

    The latter is NaN where none does, and has no columns without a rod that has play.
    """
    found = np.empty(places.shape)
    rods = (
        damper_play.EFFECT.name in (cases.dtype.names or ())
        and (cases["damper_play"]["clearance"] > 0.0).any()
    )
    pressed = np.full((len(cases), places.shape[1] - 1 if rods else 0), np.nan)
    _follow_all(cases, places, motion, step, found, pressed)
    return found, pressed


def _with_all_jumps(
    cases: np.ndarray, forces: np.ndarray, pressed: np.ndarray, velocity: np.ndarray
) -> np.ndarray:
    """Forces (n, k) with the jumps of set-valued friction at reversals, and of rods that begin to press."""
    turns, when = reversals(velocity)
    jumps = cases["friction"]["set_valued"] != 0
    if not pressed.size:
        forces[jumps] = with_jumps(forces[jumps], turns, when)
        return forces
    for row, own, at_turns in zip(forces, pressed, jumps, strict=True):
        begun = np.flatnonzero(np.isfinite(own))
        before, share = begun, own[begun]
        if at_turns:
            before, share = np.r_[turns, begun], np.r_[when, share]
        row[:] = with_jumps(row[None], before, share)[0]
    return forces


def reversals(velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The samples (j,) before the reversals of a velocity (k,), and the share of the interval until each."""
    before = np.flatnonzero(velocity[:-1] * velocity[1:] < 0.0)
    return before, velocity[before] / (velocity[before] - velocity[before + 1])


def with_jumps(forces: np.ndarray, before: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Forces (n, k) in which a jump between two samples counts for its share of the interval.

    Otherwise the time of each jump would be rounded to the grid. ``before`` (j,): the sample before each;
    ``share`` (j,): of the interval, after which it jumps.
    """
    late = share - 0.5
    jump = forces[:, before + 1] - forces[:, before]
    forces[:, before] += np.maximum(-late, 0.0) * jump
    forces[:, before + 1] -= np.maximum(late, 0.0) * jump
    return forces


@compiled
def _follow_all(cases, places, motion, step, out, pressed):
    for k in range(cases.size):
        p = cases[k]
        y = vector(np.zeros(len(scales(p))), scales(p))
        # Nobody knows where the rod begins: a motion that goes on presses it to its own side.
        y = damper_play.put(y, 1 if motion[0, 0] >= 0.0 else -1, p)
        for i in range(motion.shape[1]):
            y = replaced(replaced(y, 0, places[k, i]), 1, motion[0, i])
            out[k, i] = _force(y, motion[1, i], step, p)
            following = min(i + 1, motion.shape[1] - 1)
            # States of effects see the mean motion between two samples.
            y = replaced(y, 0, 0.5 * (places[k, i] + places[k, following]))
            y = replaced(y, 1, 0.5 * (motion[0, i] + motion[0, following]))
            moved = damper_play.moved(y, y[1] * step, p)
            if i < pressed.shape[1] and motion[0, i] * motion[0, i + 1] > 0.0:
                pressed[k, i] = damper_play.share_before_end(y, y[1] * step, p)
            y = damper_play.with_rod(_advanced(y, step, p), moved, p)


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
