"""The force that a motion takes which is imposed on the mass: no equation of motion is left to solve.

States of effects (bristles, time at rest) follow the motion. Each is integrated by the exponential Euler
method, which is exact for a rate that is linear in its state, however stiff (Hochbruck and Ostermann, 2010,
"Exponential integrators"). What moves freely between two ends moves exactly.
"""

from math import expm1, isnan, nan
from typing import Any, NamedTuple

import numpy as np

from wedgesweep.compiled import allocating, compiled, inlined, inner
from wedgesweep.hybrid.interface import (
    active,
    already_moving,
    bristles,
    driving_force,
    initial_mode,
    moved_freely,
    rate,
    scales,
    share_before_jump,
    sliders,
)
from wedgesweep.hybrid.vectors import replaced, vector
from wedgesweep.systems import grouped

# Parts of a sample over which the force is averaged where it changes quickly: regularised friction runs
# through its ramp, or bristles turn over.
PARTS = 16
# Change of bristles in an interval, as a share of their largest deflection, above which they still turn over.
FAST = 0.05
# States of the mass itself, which the motion gives, and the step of the others for their derivatives.
GIVEN, DIFFERENCE = 2, 1e-6


def forces(
    parameters: np.ndarray,
    displacement: np.ndarray,
    velocity: np.ndarray,
    acceleration: np.ndarray,
    step: float,
    deflected: float = 0.0,
    ahead: float = 0.0,
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
    deflected : float
        Deflection of bristles at the start, as a share of their largest one; of a damper's spring in series,
        beyond that of a damper that has been moving at the first velocity, as a share of the latter.
    ahead : float
        Travel (m) by which bristles are further than the mass at each sample, as if a sensor had lagged.

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
        _follow_all(cases, places[rows], motion, turns, step, (deflected, ahead), part)
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
    before = force[0]
    for i in range(shares.size):
        jump, late = force[i + 1] - before, shares[i] - 0.5
        before = force[i + 1]
        if late < 0.0:
            force[i] -= late * jump
        elif late > 0.0:
            force[i + 1] -= late * jump


@compiled
def _follow_all(cases, places, motion, turns, step, bristles_are, out):
    for k in range(cases.size):
        _follow(cases[k], places[k], motion, turns, step, bristles_are, out[k])


@allocating
def _follow(p, places, motion, turns, step, bristles_are, out):
    """Write the forces (k,) of one case.

    A force is averaged over its sample if bristles turn over in the interval before or after it. They may do
    so in the interval of a reversal, in the next one, and as long as their deflection changes quickly.
    """
    deflected, ahead = bristles_are
    shares = np.full(turns.size, nan)
    # Regularised friction does not jump where the velocity reverses.
    jumps = 1.0 if p.friction.set_valued else nan
    bristly, going_on = _has_bristles(p), False
    turned, late = False, nan  # in the interval before a sample, and the mean force of its later half
    y = already_moving(_first_state(motion[0, 0], deflected, p), deflected, p)
    for i in range(turns.size):
        y, ends = _placed(y, places[i], motion[0, i]), _Ends(places[i : i + 2], motion[:, i : i + 2])
        out[i] = _force(_ahead(y, ahead, p), motion[1, i], step, p)
        before, reverses = y, not isnan(turns[i])
        turning = bristly and (reverses or going_on)
        soon = bristly and i + 1 < turns.size and not isnan(turns[i + 1])
        if turned or turning or soon:
            y, early, later = _resolved(y, ends, turns[i], step, ahead, p)
            if turned or turning:
                out[i] = early if isnan(late) else 0.5 * (late + early)  # NaN: at the start
            late = later
        else:
            # States of effects see the mean motion between two samples.
            y = _placed(y, _between(ends.place, 0.5), _between(ends.motion[0], 0.5))
            shares[i] = jumps * turns[i] if reverses else share_before_jump(y, step, p)
            y = _moved(y, ends.motion[0, 1] - ends.motion[0, 0], step, p)
        going_on = turning and (reverses or _largest_change(before, y, p) > FAST)
        turned = turning
    last = turns.size
    y = _placed(y, places[last], motion[0, last])
    out[last] = _force(_ahead(y, ahead, p), motion[1, last], step, p)
    share_jumps(out, shares)


@allocating
def _first_state(velocity, deflected, p):
    """State vector at the start of a motion."""
    y, shares = replaced(vector(np.zeros(len(scales(p))), scales(p)), 1, velocity), bristles(p)
    for place in range(GIVEN, len(y)):
        if shares[place]:
            y = replaced(y, place, deflected)
    return y


class _Ends(NamedTuple):
    """Motion at both ends of an interval: displacement (2,) (m), and velocity and acceleration (2, 2)."""

    place: Any
    motion: Any


@inlined
def _between(values, share):
    """Value at a share of an interval, from those at its ends."""
    return (1.0 - share) * values[0] + share * values[1]


@inlined
def _placed(y, displacement, velocity):
    """The state vector at a displacement and velocity of the mass."""
    return replaced(replaced(y, 0, displacement), 1, velocity)


@inner
def _ahead(y, travel, p):
    """The state vector with bristles that have moved on by some travel (m), whichever way the mass moves."""
    if travel == 0.0 or y[1] == 0.0:
        return y
    found, later, shares = y, _moved(y, 0.0, travel / abs(y[1]), p), bristles(p)
    for place in range(GIVEN, len(y)):
        if shares[place]:
            found = replaced(found, place, later[place])
    return found


@inner
def _has_bristles(p):
    """Whether a contact has bristles."""
    found, shares, acting = False, bristles(p), active(p)
    for place in range(len(shares)):
        found = found or (shares[place] and acting[place])
    return found


@inner
def _largest_change(before, after, p):
    """Largest change of bristles, as a share of their largest deflection."""
    found, shares = 0.0, bristles(p)
    for place in range(GIVEN, len(before)):
        if shares[place]:
            found = max(found, abs(after[place] - before[place]))
    return found


@inner
def _resolved(y, ends, turn, step, ahead, p):
    """State after an interval in which bristles turn over, and the mean forces over both halves of it.

    ``turn``: share of the interval at which the velocity reverses, or NaN.
    """
    turn = 0.5 if isnan(turn) else turn
    edges = (0.0, min(turn, 0.5), max(turn, 0.5), 1.0)
    early = late = 0.0
    for piece in range(len(edges) - 1):
        part = (edges[piece + 1] - edges[piece]) / (PARTS // 2)
        for i in range(PARTS // 2):
            share = edges[piece] + (i + 0.5) * part
            acceleration = _between(ends.motion[1], share)
            y = _placed(y, _between(ends.place, share), _between(ends.motion[0], share))
            y = _moved(y, 0.0, 0.5 * part * step, p)
            there = _ahead(y, ahead, p)
            force = driving_force(0.0, acceleration, there, initial_mode(0.0, there, p)[0], p)
            y = _moved(y, 0.0, 0.5 * part * step, p)
            if share < 0.5:
                early += 2.0 * part * force
            else:
                late += 2.0 * part * force
    return y, early, late


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


@inlined
def _moved(y, change, step, p):
    """The state vector after a step at a mean velocity of the mass, which grows by ``change``."""
    return moved_freely(y, _advanced(y, step, p), change, step, p)


@inner
def _advanced(y, step, p):
    """The state vector with the effects' own states after a step, by their rates."""
    mode = initial_mode(0.0, y, p)[0]
    now, size, moving, closed = rate(0.0, y, mode, p)[0], scales(p), active(p), sliders(p)
    following = y
    for place in range(GIVEN, len(y)):
        if closed[place] or not moving[place]:
            continue
        moved = DIFFERENCE * size[place]
        beside = rate(0.0, replaced(y, place, y[place] + moved), mode, p)[0]
        growth = step * (beside[place] - now[place]) / moved
        share = expm1(growth) / growth if growth != 0.0 else 1.0
        following = replaced(following, place, y[place] + step * share * now[place])
    return following
