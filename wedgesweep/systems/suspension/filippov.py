"""Jumps of friction that hold a velocity: Filippov's convex combination of both sides (1988).

A jump holds the slip of a face at its threshold, or the bolster at rest where friction depends on the sign
of z'. If several hold at once, each combination of their sides (a vertex) is a mode of its own, and the jumps
are resolved one after the other, so that all held velocities stay constant.
"""

import numpy as np

from wedgesweep.compiled import allocating, inlined, inner
from wedgesweep.systems.suspension.energy import friction_power
from wedgesweep.systems.suspension.faces import slip_rate
from wedgesweep.systems.suspension.modes import AXES, HELD, held, side, with_branch
from wedgesweep.systems.suspension.newton import Forces, forces, solve_for_signs

# Numbers of a vertex: the five forces, then the power of friction.
WIDTH, POWER = 6, 5


@inner
def _vertex(mode, bits, order, p):
    """Mode at a vertex: bit i of ``bits`` is the side (1: higher) of the jump of axis ``order[i]``."""
    for i in range(order.size):
        axis = order[i]
        mode = with_branch(mode, axis, side(mode[axis], axis, (bits >> i) & 1), p)
    return mode


@allocating
def both_sides(t, y, mode, first, p, out):
    """Write both sides of the jump of axis ``first``, shape (2, WIDTH), the other jumps resolved.

    Returns whether the normal forces are unique at every vertex.
    """
    order = np.empty(AXES, np.int64)
    order[0] = first
    count = 1
    for axis in range(AXES):
        if axis != first and abs(mode[axis]) == HELD:
            order[count] = axis
            count += 1
    order = order[:count]
    vertices = np.empty((1 << count, WIDTH))
    unique = True
    for bits in range(1 << count):
        at, now, certain = solve_for_signs(t, y, _vertex(mode, bits, order, p), p)
        unique = unique and certain
        vertices[bits, 0], vertices[bits, 1], vertices[bits, 2] = now[0], now[1], now[2]
        vertices[bits, 3], vertices[bits, 4] = now.column, now.bolster
        vertices[bits, POWER] = friction_power(t, y, at, now, p)
    for i in range(count - 1, 0, -1):
        for low in range(1 << i):
            _resolve(order[i], t, y, vertices[low], vertices[low + (1 << i)], p)
    for i in range(WIDTH):
        out[0, i], out[1, i] = vertices[0, i], vertices[1, i]
    return unique


@inner
def _resolve(axis, t, y, low, high, p):
    """Combine both sides of a jump so that its measure of slip stays constant; ``low`` is replaced."""
    below = slip_rate(axis, t, y, low[0], low[1], p)
    above = slip_rate(axis, t, y, high[0], high[1], p)
    share = above / (above - below) if above != below else 0.5
    for i in range(WIDTH):
        low[i] = share * low[i] + (1.0 - share) * high[i]


@allocating
def filippov_forces(t, y, mode, p):
    """Forces and friction power (W) of a mode with held velocities, and whether they are unique."""
    sides = np.empty((2, WIDTH))
    axis = 0
    while abs(mode[axis]) != HELD:
        axis += 1
    unique = both_sides(t, y, mode, axis, p, sides)
    _resolve(axis, t, y, sides[0], sides[1], p)
    now = sides[0]
    return Forces(now[0], now[1], now[2], now[3], now[4]), now[POWER], unique


@inlined
def forces_of_mode(t, y, mode, p):
    """Forces in any mode but a stuck one."""
    if held(mode):
        return filippov_forces(t, y, mode, p)[0]
    return forces(t, y, mode, p)


@inner
def resolve_mode(t, y, mode, p):
    """``forces_of_mode`` with the signs of the normal forces found: mode, forces, whether they are unique."""
    if held(mode):
        now, _, unique = filippov_forces(t, y, mode, p)
        return mode, now, unique
    return solve_for_signs(t, y, mode, p)
