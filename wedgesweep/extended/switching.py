"""Rates, switches and successors of the extended system: all that an integrator needs to know.

It follows one mode while all ``switches`` are positive; when one reaches zero it asks for the
``successor`` and goes on from there.
"""

from math import hypot, inf, nan

import numpy as np

from wedgesweep.compiled import compiled, inlined
from wedgesweep.contact import AT_JUMP, LOOK_AHEAD, ROUNDING
from wedgesweep.excitation import table_acceleration
from wedgesweep.extended.faces import bolster_slip, column_slip, cross_velocity, sliding
from wedgesweep.extended.jumps import WIDTH, acting, blend, settled, slip_rate
from wedgesweep.extended.mechanics import Forces, closed, forces, riding, write_rate
from wedgesweep.extended.mode import (
    AGE,
    AXES,
    BOLSTER_NORMAL,
    CLOCK,
    COLUMN,
    COLUMN_NORMAL,
    DIRECTION,
    SIZE,
    STOP,
    VELOCITY,
    Mode,
    X,
    beyond,
    branch,
    held,
    stuck,
    with_branch,
)

# A ramp of friction reaches this much into the branches beside it, so that a slip velocity that grazes its
# end cannot go back and forth between both at one instant.
OVERLAP = 1e-9
# Moments after a rest by which the input has moved the bolster, through whatever is between.
OUTSET = 4
NOT_ASKED = Forces(nan, nan, nan, nan, nan)


@compiled
def rate(t, y, mode, p, out):
    """Write dy/dt, shape (SIZE,); returns the forces."""
    now = riding(t, y, mode, p) if stuck(mode, p) else acting(t, y, mode, p)
    write_rate(y, mode, now, p, out)
    return now


@compiled
def slipping(direction, stop, clock, p):
    """Mode of a set-valued law as z' has the given sign; ``clock`` = 1: about to, still at rest."""
    ratio = p.bolster_ratio
    bolster = direction if ratio > 0.0 else -direction
    if ratio == 0.0:
        bolster = 0
    sign = direction if p.directional_friction_asymmetry != 0.0 else 0
    return Mode(direction, bolster, direction, 1, 1, sign, stop, clock)


@compiled
def breakaway(t, y, direction, stop, p):
    """Acceleration z'' (m/s^2) if set-valued friction let go in a direction, and whether it is unique."""
    _, now, unique = closed(t, y, slipping(direction, stop, 1, p), p)
    return now.acceleration, unique


@compiled
def from_rest(t, y, stop, p):
    """Mode that follows z' = 0 under a set-valued law, and whether it is unique."""
    rising, forward_unique = breakaway(t, y, 1, stop, p)
    falling, backward_unique = breakaway(t, y, -1, stop, p)
    unique = forward_unique and backward_unique and not (rising > 0.0 and falling < 0.0)
    nearly_none = ROUNDING * (p.gravity + abs(table_acceleration(t, p)))
    if rising <= nearly_none and falling >= -nearly_none:
        return Mode(0, 0, 0, 1, 1, 0, stop, 1), unique
    mode, _, certain = closed(t, y, slipping(1 if rising > 0.0 else -1, stop, 0, p), p)
    return mode, unique and certain


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
def _branch_at(slip, threshold):
    if slip > threshold:
        return 1
    return -1 if slip < -threshold else 0


@compiled
def _velocity_soon(t, y, mode, p):
    """Rate of z a few moments after a rest.

    Where a run begins forces balance but for rounding, and the input may have to pass through other states
    before it moves the bolster.
    """
    moment = LOOK_AHEAD / p.omega
    later, slope = y.copy(), np.empty(SIZE)
    for i in range(OUTSET):
        rate(t + (i + 0.5) * moment, later, mode, p, slope)
        later += moment * slope
    return later[VELOCITY]


@compiled
def _direction_at(t, y, mode, p):
    """The mode with the direction of z', and whether it is unique."""
    if p.directional_friction_asymmetry == 0.0:
        return closed(t, y, mode, p)
    upward, now, unique = closed(t, y, with_branch(mode, 3, 1, p), p)
    if y[VELOCITY] > 0.0 or (y[VELOCITY] == 0.0 and _velocity_soon(t, y, upward, p) > 0.0):
        return upward, now, unique
    downward, now, unique = closed(t, y, with_branch(mode, 3, -1, p), p)
    if y[VELOCITY] < 0.0 or _velocity_soon(t, y, downward, p) < 0.0:
        return downward, now, unique
    return settled(t, y, with_branch(mode, 3, AT_JUMP, p), p)


@compiled
def initial(t, y, p):
    """Mode at the start of a run, and whether it is unique."""
    stop = _branch_at(y[X], p.end_stop_clearance) if p.end_stop_stiffness > 0.0 else 0
    if stop == 0 and p.end_stop_stiffness > 0.0 and p.end_stop_clearance == 0.0:
        stop = 1
    if p.set_valued:
        if y[VELOCITY] == 0.0:
            return from_rest(t, y, stop, p)
        mode = slipping(1 if y[VELOCITY] > 0.0 else -1, stop, 0, p)
        found, _, unique = closed(t, y, mode, p)
        return found, unique
    threshold = p.threshold_velocity
    column = _branch_at(slip_measure(0, t, y, p), threshold)
    clock = 1 if column == 0 else 0
    if p.presliding_length > 0.0:
        clock = 1 if abs(column_slip(y, p)) <= threshold else 0
        column = 1 if column_slip(y, p) >= 0.0 else -1
    bolster = _branch_at(slip_measure(1, t, y, p), threshold)
    guide = _branch_at(y[VELOCITY], threshold)
    found, _, unique = _direction_at(t, y, Mode(column, bolster, guide, 1, 1, 0, stop, clock), p)
    return found, unique


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
def switches(t, y, mode, p, out):
    """Write the switching functions, shape (SWITCHES,): positive while the mode holds.

    Units are m/s for slip velocities, m for the end stops, N for normal forces, m/s^2 for what is held
    or stuck; a switch that the mode does not have is inf.
    """
    if stuck(mode, p) or held(mode):
        switches_under(NOT_ASKED, t, y, mode, p, out)
    else:
        switches_under(forces(t, y, mode, p), t, y, mode, p, out)


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


@compiled
def unique(t, y, mode, p):
    """Whether the state has exactly one pair of normal forces; if not, the wedge locks."""
    if p.never_locks:
        return True
    if stuck(mode, p):
        return from_rest(t, y, mode.stop, p)[1]
    return settled(t, y, mode, p)[2]


@compiled
def _ahead(t, y, mode, time, p):
    """State a moment later, to first order."""
    slope = np.empty(SIZE)
    rate(t, y, mode, p, slope)
    later = y + time * slope
    later[X] += 0.5 * time * time * slope[VELOCITY]
    return later


@compiled
def _past_zero_force(t, y, mode, p):
    """Mode after a normal force has become zero, and whether it is unique; see contact.py."""
    ahead = LOOK_AHEAD / p.omega
    found, certain = mode, True
    for _ in range(4):
        later = _ahead(t, y, mode, ahead, p)
        found, now, certain = closed(t + ahead, later, mode, p)
        weight = p.bolster_mass * (p.gravity + abs(table_acceleration(t + ahead, p)))
        if min(abs(now.column), abs(now.bolster)) > ROUNDING * weight:
            break
        ahead *= 30.0
    return found, certain


@compiled
def _released(t, y, direction, stop, p):
    """Direction in which the bolster leaves rest; with next to no friction the switch may be noise."""
    ahead = t + LOOK_AHEAD / p.omega
    onward = direction * breakaway(ahead, y, direction, stop, p)[0]
    back = -direction * breakaway(ahead, y, -direction, stop, p)[0]
    return -direction if onward <= 0.0 < back else direction


@compiled
def _continuous(axis, p):
    """Whether friction goes over from one branch of an axis to the next without a jump."""
    if axis >= 2:
        return axis == 2
    if axis == 0 and p.presliding_length > 0.0:
        return True
    jump = p.static + p.stribeck_peak - sliding(p.threshold_velocity, p)
    return p.ageing_rate == 0.0 and abs(jump) <= ROUNDING * p.dynamic


@compiled
def _over_jump(t, y, mode, switch, p):
    """Mode behind the end of a branch, or at the jump where the side behind points back to it."""
    axis = switch // 2
    was_held = abs(branch(mode, axis)) == AT_JUMP
    across, now, certain = settled(t, y, beyond(mode, switch, False, p), p)
    onward = slip_rate(axis, t, y, now.acceleration, now.column_acceleration, p)
    if was_held or _continuous(axis, p) or (onward if switch % 2 else -onward) >= 0.0:
        return across, certain
    found, _, certain = settled(t, y, beyond(mode, switch, True, p), p)
    return found, certain


@compiled
def _next_stop(mode, switch, p):
    """Mode after an end stop has been reached or left."""
    step = 2 * (switch % 2) - 1
    column, bolster, guide, column_sign, bolster_sign, direction, stop, clock = mode
    following = stop + step
    if following == 0 and p.end_stop_clearance == 0.0:
        following = step
    return Mode(column, bolster, guide, column_sign, bolster_sign, direction, following, clock)


@compiled
def _turned_clock(mode):
    column, bolster, guide, column_sign, bolster_sign, direction, stop, clock = mode
    return Mode(column, bolster, guide, column_sign, bolster_sign, direction, stop, 1 - clock)


@compiled
def _successor(t, y, mode, switch, p):
    if switch in (COLUMN_NORMAL, BOLSTER_NORMAL):
        return _past_zero_force(t, y, mode, p)
    if STOP <= switch < COLUMN_NORMAL or switch == CLOCK:
        after = _turned_clock(mode) if switch == CLOCK else _next_stop(mode, switch, p)
        found, _, certain = settled(t, y, after, p)
        return found, certain
    if not p.set_valued:
        return _over_jump(t, y, mode, switch, p)
    y[VELOCITY] = 0.0
    if not stuck(mode, p):
        y[AGE] = 0.0
        return from_rest(t, y, mode.stop, p)
    direction = _released(t, y, 1 if switch == COLUMN + 1 else -1, mode.stop, p)
    found, _, certain = closed(t, y, slipping(direction, mode.stop, 0, p), p)
    return found, certain


@compiled
def successor(t, y, mode, switch, p):
    """Mode after a switch has reached zero, and whether it is unique (if not: locked).

    Changes y where the switch does: set-valued friction stops the bolster, slip ends the time at rest.
    """
    found, certain = _successor(t, y, mode, switch, p)
    if not found.clock:
        y[AGE] = 0.0
    return found, certain
