"""Event functions of the suspension: positive while a contact mode holds, zero where it ends."""

from math import inf

import numpy as np

from wedgesweep import friction
from wedgesweep.compiled import allocating, inlined, inner
from wedgesweep.effects import ageing, guide_friction, presliding, travel
from wedgesweep.systems.suspension.faces import column_slip, slip_measure, slip_rate
from wedgesweep.systems.suspension.filippov import WIDTH, both_sides
from wedgesweep.systems.suspension.modes import (
    AXES,
    BOLSTER,
    COLUMN,
    DIRECTION,
    GUIDE,
    HELD,
    VELOCITY,
    X,
    held,
    stuck,
)
from wedgesweep.systems.suspension.newton import UNDETERMINED, forces
from wedgesweep.systems.suspension.set_valued import acceleration_on_breakaway

# Places of the event functions other than those of the axes: both normal forces, two ends of the segment of
# travel, time at rest.
COLUMN_NORMAL, BOLSTER_NORMAL, TRAVEL, CLOCK = 2 * AXES, 2 * AXES + 1, 2 * AXES + 2, 2 * AXES + 4
EVENTS = CLOCK + 1


@inlined
def _bristle_events(t, y, mode, p, out):
    """Write the events of a column face with bristles: the slip turns, the time at rest begins or ends."""
    slip = column_slip(y, p)
    out[2 * COLUMN if mode.column > 0 else 2 * COLUMN + 1] = mode.column * slip
    if ageing.acts(p):
        inside = p.friction.v_t - abs(slip)
        out[CLOCK] = inside if mode.clock else -inside


@inlined
def _slip_events(t, y, mode, p, out):
    """Write the events of a regularised law that no jump holds."""
    v_t = p.friction.v_t
    if presliding.acts(p):
        _bristle_events(t, y, mode, p, out)
    elif abs(mode.column) != HELD:
        friction.write_branch_ends(slip_measure(COLUMN, t, y, p), v_t, mode.column, 2 * COLUMN, out)
    if abs(mode.bolster) != HELD:
        friction.write_branch_ends(slip_measure(BOLSTER, t, y, p), v_t, mode.bolster, 2 * BOLSTER, out)
    if guide_friction.acts(p) and abs(mode.guide) != HELD:
        friction.write_branch_ends(y[VELOCITY], v_t, mode.guide, 2 * GUIDE, out)
    if abs(mode.direction) == 1:
        out[2 * DIRECTION if mode.direction > 0 else 2 * DIRECTION + 1] = mode.direction * y[VELOCITY]


@allocating
def _held_events(t, y, mode, p, out):
    """Write the events of held velocities: a jump holds one while slip on both sides accelerates to it."""
    sides = np.empty((2, WIDTH))
    for axis in range(AXES):
        if abs(mode[axis]) == HELD:
            both_sides(t, y, mode, axis, p, sides)
            out[2 * axis] = slip_rate(axis, t, y, sides[0, 0], sides[0, 1], p)
            out[2 * axis + 1] = -slip_rate(axis, t, y, sides[1, 0], sides[1, 1], p)


@inlined
def _kinematic_events(t, y, mode, p, out):
    """Write the events that need no forces."""
    if travel.acts(p):
        travel.write_events(y[X], mode.segment, p, TRAVEL, out)
    if p.friction.set_valued:
        out[2 * COLUMN if mode.column > 0 else 2 * COLUMN + 1] = mode.column * y[VELOCITY]
    else:
        _slip_events(t, y, mode, p, out)


@inner
def events(now, t, y, mode, p, out):
    """Write the event functions, shape (EVENTS,), under the forces ``now`` (not used if held or stuck).

    Units are m/s for slip velocities, m for the travel, N for normal forces, m/s^2 for a velocity that a jump
    or sticking holds; an event that the mode does not have is inf.
    """
    for i in range(EVENTS):
        out[i] = inf
    if stuck(mode, p):
        out[2 * COLUMN] = acceleration_on_breakaway(t, y, -1, mode.segment, p)
        out[2 * COLUMN + 1] = -acceleration_on_breakaway(t, y, 1, mode.segment, p)
        return
    _kinematic_events(t, y, mode, p, out)
    if held(mode):
        _held_events(t, y, mode, p, out)
    else:
        out[COLUMN_NORMAL] = mode.column_sign * now.column
        out[BOLSTER_NORMAL] = mode.bolster_sign * now.bolster


@inlined
def _time_to_end(slip, rate, branch, threshold, p):
    """Time (s) in which a slip velocity reaches the end of its branch at a constant rate; inf: never.

    It is inf as well on a sliding branch whose coefficient depends on velocity: a step that aims at the end
    of the branch has stages beyond it, where the coefficient would grow fast.
    """
    if branch != 0 and friction.exponent(p) != 0.0:
        return inf
    if branch == 0:
        return (threshold - slip if rate > 0.0 else -threshold - slip) / rate if rate != 0.0 else inf
    return (branch * threshold - slip) / rate if branch * rate < 0.0 else inf


@inlined
def expected_event(now, t, y, mode, p):
    """Time (s) in which the column or bolster face would reach the end of its branch at constant rates."""
    if stuck(mode, p) or held(mode) or presliding.acts(p):
        return inf
    column, bolster = slip_measure(COLUMN, t, y, p), slip_measure(BOLSTER, t, y, p)
    of_column = slip_rate(COLUMN, t, y, now.acceleration, now.column_acceleration, p)
    if p.friction.set_valued:
        return _time_to_end(column, of_column, mode.column, 0.0, p)
    of_bolster = slip_rate(BOLSTER, t, y, now.acceleration, now.column_acceleration, p)
    return min(
        _time_to_end(column, of_column, mode.column, p.friction.v_t, p),
        _time_to_end(bolster, of_bolster, mode.bolster, p.friction.v_t, p),
    )


@inlined
def _is_kinematic(place, mode, p):
    """Whether an event function needs no forces."""
    if stuck(mode, p) or place in (COLUMN_NORMAL, BOLSTER_NORMAL):
        return False
    return place >= TRAVEL or abs(mode[place // 2]) != HELD


@inner
def event(place, t, y, mode, p, out):
    """One of the event functions; ``out`` is not written in full."""
    if _is_kinematic(place, mode, p):
        _kinematic_events(t, y, mode, p, out)
    elif stuck(mode, p) or held(mode):
        events(UNDETERMINED, t, y, mode, p, out)
    else:
        events(forces(t, y, mode, p), t, y, mode, p, out)
    return out[place]
