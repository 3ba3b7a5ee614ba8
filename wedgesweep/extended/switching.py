"""Rates of the extended system, the mode in which a run begins, and what comes after each.

An integrator follows one mode while all ``switches`` are positive; when one reaches zero it asks for the
``successor`` and goes on from there.
"""

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.contact import AT_JUMP, LOOK_AHEAD, ROUNDING
from wedgesweep.excitation import table_acceleration
from wedgesweep.extended.faces import column_slip, sliding
from wedgesweep.extended.jumps import acting, settled, slip_rate
from wedgesweep.extended.mechanics import closed, riding, write_rate
from wedgesweep.extended.mode import (
    AGE,
    BOLSTER_NORMAL,
    CLOCK,
    COLUMN,
    COLUMN_NORMAL,
    SIZE,
    STOP,
    VELOCITY,
    Mode,
    X,
    beyond,
    branch,
    stuck,
    with_branch,
)
from wedgesweep.extended.set_valued import from_rest, released, slipping
from wedgesweep.extended.switches import slip_measure

# Moments after a rest by which the input has moved the bolster, through whatever is between.
OUTSET = 4


@compiled
def rate(t, y, mode, p, out):
    """Write dy/dt, shape (SIZE,); returns the forces."""
    now = riding(t, y, mode, p) if stuck(mode, p) else acting(t, y, mode, p)
    write_rate(y, mode, now, p, out)
    return now


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
    direction = released(t, y, 1 if switch == COLUMN + 1 else -1, mode.stop, p)
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
