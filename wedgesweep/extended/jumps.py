"""Jumps of friction that hold a velocity: Filippov's (1988) convex combination of both sides.

A jump holds the slip of a face at its threshold, or the bolster at rest where friction depends on the
sign of z'. Several may hold at once: then each corner of the combination is a mode of its own, and the
jumps are resolved one after the other, so that all their velocities stay.
"""

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.contact import AT_JUMP
from wedgesweep.extended.faces import bolster_slip, column_slip, cross_velocity
from wedgesweep.extended.mechanics import Forces, closed, forces
from wedgesweep.extended.mode import AXES, branch, held, side, with_branch
from wedgesweep.extended.power import friction_power

# Columns of a corner: the five forces, then the power of friction.
WIDTH, POWER = 6, 5


@compiled
def measure(axis, t, y, p):
    """Rate of an axis's measure of slip as c0 + cz z'' + cq Q'': (c0, cz, cq).

    The measure is v in the plane or, with slip W out of it, |V|.
    """
    if axis >= 2:
        return 0.0, 1.0, 0.0
    if axis == 0:
        velocity, by_z, by_way = column_slip(y, p), p.column_ratio, p.column_slip_ratio
    else:
        velocity, by_z, by_way = bolster_slip(y, p), p.bolster_ratio, p.bolster_slip_ratio
    if p.cross_slip_velocity == 0.0:
        return 0.0, by_z, by_way
    across = cross_velocity(t, p)
    turning = -p.cross_slip_velocity * p.omega * np.sin(p.omega * t + p.cross_slip_phase)
    speed = max(np.hypot(velocity, across), 1e-12 * p.threshold_velocity)
    return across * turning / speed, velocity * by_z / speed, velocity * by_way / speed


@compiled
def slip_rate(axis, t, y, acceleration, column_acceleration, p):
    """Rate of an axis's measure of slip (m/s^2)."""
    rest, by_z, by_way = measure(axis, t, y, p)
    return rest + by_z * acceleration + by_way * column_acceleration


@compiled
def _corner(mode, bits, order, p):
    """Mode at a corner: bit i says on which side of the jump of ``order[i]`` it lies."""
    for i in range(order.size):
        axis = order[i]
        mode = with_branch(mode, axis, side(branch(mode, axis), axis, (bits >> i) & 1), p)
    return mode


@compiled
def blend(t, y, mode, first, p, out):
    """Write both sides of the jump of axis ``first``, shape (2, WIDTH), the other jumps resolved.

    Returns whether the normal forces are unique at every corner.
    """
    order = np.empty(AXES, np.int64)
    order[0] = first
    count = 1
    for axis in range(AXES):
        if axis != first and abs(branch(mode, axis)) == AT_JUMP:
            order[count] = axis
            count += 1
    order = order[:count]
    corners = np.empty((2**count, WIDTH))
    unique = True
    for bits in range(2**count):
        at, now, certain = closed(t, y, _corner(mode, bits, order, p), p)
        unique = unique and certain
        corners[bits, 0], corners[bits, 1], corners[bits, 2] = now[0], now[1], now[2]
        corners[bits, 3], corners[bits, 4] = now.column, now.bolster
        corners[bits, POWER] = friction_power(t, y, at, now, p)
    for i in range(count - 1, 0, -1):
        for low in range(2**i):
            _resolve(order[i], t, y, corners[low], corners[low + 2**i], p, corners[low])
    out[0], out[1] = corners[0], corners[1]
    return unique


@compiled
def _resolve(axis, t, y, low, high, p, out):
    """Combine two sides of a jump so that its measure of slip stays."""
    below = slip_rate(axis, t, y, low[0], low[1], p)
    above = slip_rate(axis, t, y, high[0], high[1], p)
    share = above / (above - below) if above != below else 0.5
    for i in range(WIDTH):
        out[i] = share * low[i] + (1.0 - share) * high[i]


@compiled
def first_held(mode):
    """The first axis that a jump holds."""
    for axis in range(AXES):
        if abs(branch(mode, axis)) == AT_JUMP:
            return axis
    return -1


@compiled
def combined(t, y, mode, p):
    """Forces and friction power (W) of a mode with held velocities, and whether they are unique."""
    sides = np.empty((2, WIDTH))
    axis = first_held(mode)
    unique = blend(t, y, mode, axis, p, sides)
    _resolve(axis, t, y, sides[0], sides[1], p, sides[0])
    now = sides[0]
    return Forces(now[0], now[1], now[2], now[3], now[4]), now[POWER], unique


@compiled
def acting(t, y, mode, p):
    """Forces on any mode but a stuck one."""
    if held(mode):
        return combined(t, y, mode, p)[0]
    return forces(t, y, mode, p)


@compiled
def settled(t, y, mode, p):
    """``acting`` with the signs of the normal forces found: mode, forces, whether they are unique."""
    if held(mode):
        now, _, unique = combined(t, y, mode, p)
        return mode, now, unique
    return closed(t, y, mode, p)
