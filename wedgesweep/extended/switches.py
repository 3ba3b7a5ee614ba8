"""Switching functions of the extended system: positive while a mode holds, zero where it ends."""

from math import hypot, inf, nan

import numpy as np

from wedgesweep.compiled import compiled, inlined
from wedgesweep.contact import AT_JUMP
from wedgesweep.extended.faces import bolster_slip, column_slip, cross_velocity
from wedgesweep.extended.jumps import WIDTH, blend, slip_rate
from wedgesweep.extended.mechanics import Forces, forces
from wedgesweep.extended.mode import (
    AXES,
    BOLSTER_NORMAL,
    CLOCK,
    COLUMN,
    COLUMN_NORMAL,
    DIRECTION,
    STOP,
    VELOCITY,
    X,
    branch,
    held,
    stuck,
)
from wedgesweep.extended.set_valued import breakaway

# A ramp of friction reaches this much into the branches beside it, so that a slip velocity that grazes its
# end cannot go back and forth between both at one instant.
OVERLAP = 1e-9
NOT_ASKED = Forces(nan, nan, nan, nan, nan)


@compiled
def slip_measure(axis, t, y, p):
    """Measure of slip (m/s) that decides on the branch of an axis; see ``jumps.measure``."""
    if axis >= 2:
        return y[VELOCITY]
    velocity = column_slip(y, p) if axis == 0 else bolster_slip(y, p)
    if p.cross_slip_velocity == 0.0:
        return velocity
    return hypot(velocity, cross_velocity(t, p))


@compiled
def _ends(value, threshold, now, place, out):
    """Write the distances of a measure of slip to the lower and the upper end of its branch."""
    if now == 0:
        threshold *= 1.0 + OVERLAP
    if now >= 0:
        out[place] = value - threshold if now else value + threshold
    if now <= 0:
        out[place + 1] = -threshold - value if now else threshold - value


@compiled
def _stop_switches(x, stop, p, out):
    if stop >= 0:
        out[STOP] = x - p.end_stop_clearance if stop else x + p.end_stop_clearance
    if stop <= 0:
        out[STOP + 1] = -p.end_stop_clearance - x if stop else p.end_stop_clearance - x


@compiled
def _slip_switches(t, y, mode, p, out):
    """Write the switches of a regularised law that no jump holds."""
    if p.presliding_length > 0.0:
        slip = column_slip(y, p)
        out[COLUMN if mode.column > 0 else COLUMN + 1] = mode.column * slip
        if p.ageing_rate > 0.0:
            inside = p.threshold_velocity - abs(slip)
            out[CLOCK] = inside if mode.clock else -inside
    for axis in range(AXES - 1):
        now = branch(mode, axis)
        present = (axis > 0 or p.presliding_length == 0.0) and (axis < 2 or p.guide_friction_force > 0.0)
        if present and abs(now) != AT_JUMP:
            _ends(slip_measure(axis, t, y, p), p.threshold_velocity, now, 2 * axis, out)
    if abs(mode.direction) == 1:
        out[DIRECTION if mode.direction > 0 else DIRECTION + 1] = mode.direction * y[VELOCITY]


@compiled
def _held_switches(t, y, mode, p, out):
    """Write the switches of the jumps that hold a velocity: the sides must point at the jump."""
    sides = np.empty((2, WIDTH))
    for axis in range(AXES):
        if abs(branch(mode, axis)) == AT_JUMP:
            blend(t, y, mode, axis, p, sides)
            out[2 * axis] = slip_rate(axis, t, y, sides[0, 0], sides[0, 1], p)
            out[2 * axis + 1] = -slip_rate(axis, t, y, sides[1, 0], sides[1, 1], p)


@compiled
def _kinematic_switches(t, y, mode, p, out):
    """Write the switches that need no forces."""
    if p.end_stop_stiffness > 0.0:
        _stop_switches(y[X], mode.stop, p, out)
    if p.set_valued:
        out[COLUMN if mode.column > 0 else COLUMN + 1] = mode.column * y[VELOCITY]
    else:
        _slip_switches(t, y, mode, p, out)


@compiled
def switches_under(now, t, y, mode, p, out):
    """``switches`` where the forces are known (of a mode that holds or sticks they are not asked for)."""
    out[:] = inf
    if stuck(mode, p):
        out[COLUMN] = breakaway(t, y, -1, mode.stop, p)[0]
        out[COLUMN + 1] = -breakaway(t, y, 1, mode.stop, p)[0]
        return
    _kinematic_switches(t, y, mode, p, out)
    if held(mode):
        _held_switches(t, y, mode, p, out)
    else:
        out[COLUMN_NORMAL] = mode.column_sign * now.column
        out[BOLSTER_NORMAL] = mode.bolster_sign * now.bolster


@compiled
def switches(t, y, mode, p, out):
    """Write the switching functions, shape (SWITCHES,): positive while the mode holds.

    Units are m/s for slip velocities, m for the end stops, N for normal forces, m/s^2 for what is held
    or stuck; a switch that the mode does not have is inf.
    """
    if stuck(mode, p) or held(mode):
        switches_under(NOT_ASKED, t, y, mode, p, out)
    else:
        switches_under(forces(t, y, mode, p), t, y, mode, p, out)


@inlined
def _is_kinematic(place, mode, p):
    if stuck(mode, p) or place in (COLUMN_NORMAL, BOLSTER_NORMAL):
        return False
    return place >= STOP or abs(branch(mode, place // 2)) != AT_JUMP


@compiled
def one_switch(place, t, y, mode, p, out):
    """One of the ``switches``, which may be all that is written."""
    if _is_kinematic(place, mode, p):
        _kinematic_switches(t, y, mode, p, out)
    else:
        switches(t, y, mode, p, out)
    return out[place]
