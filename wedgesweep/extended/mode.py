"""State and modes of the extended system: which of its smooth pieces holds.

The state y has shape (SIZE,): deflection x and x' (m, m/s), bristle share b, way Q of a column from its
static place and Q' (m, m/s), way d of the side frame against its table and d' (m, m/s), and the time at
rest (s) that ages the faces. What an effect does not use stays 0, and 0 is the state at rest.
"""

from math import pi
from typing import NamedTuple

import numpy as np

from wedgesweep.compiled import compiled, inlined
from wedgesweep.contact import AT_JUMP

X, VELOCITY, BRISTLE, COLUMN_WAY, COLUMN_VELOCITY, FRAME_WAY, FRAME_VELOCITY, AGE = range(8)
SIZE = 8

# Places of the switches; the first six have two each: leave the branch toward lower, toward higher.
COLUMN, BOLSTER, GUIDE, DIRECTION, STOP, COLUMN_NORMAL, BOLSTER_NORMAL, CLOCK = 0, 2, 4, 6, 8, 10, 11, 12
SWITCHES = 13
# What a jump can hold, by their places over 2.
AXES = 4


@inlined
def unit(place, p):
    """Unit of a state: share of 1, a forcing period, input amplitude or velocity."""
    if place == BRISTLE:
        return 1.0
    if place == AGE:
        return 2.0 * pi / p.omega
    if place in (X, COLUMN_WAY, FRAME_WAY):
        return p.amplitude
    return p.amplitude * p.omega


@compiled
def units(p):
    """Units of all states, shape (SIZE,)."""
    size = np.empty(SIZE)
    for place in range(SIZE):
        size[place] = unit(place, p)
    return size


@compiled
def in_use(p):
    """Whether a case uses each of the states, shape (SIZE,)."""
    found = np.zeros(SIZE, np.bool_)
    found[X] = found[VELOCITY] = True
    found[BRISTLE] = p.presliding_length > 0.0
    found[COLUMN_WAY] = found[COLUMN_VELOCITY] = p.column_compliance_stiffness > 0.0
    found[FRAME_WAY] = found[FRAME_VELOCITY] = p.fixture_stiffness > 0.0
    found[AGE] = p.ageing_rate > 0.0
    return found


class Mode(NamedTuple):
    """``damper.Contact``, and what the effects add to it.

    ``direction``: sign of z' where friction depends on it, AT_JUMP where its jump holds the bolster, else 0.
    ``stop``: -1, 0, 1, the end stop in contact. ``clock``: 1 while time at rest runs.
    """

    column: int
    bolster: int
    guide: int
    column_sign: int
    bolster_sign: int
    direction: int
    stop: int
    clock: int


@inlined
def stuck(mode, p):
    """Whether set-valued friction holds the bolster."""
    return p.set_valued and mode.column == 0


@inlined
def held(mode):
    """Whether the jump of a friction law holds a velocity."""
    return (
        abs(mode.column) == AT_JUMP
        or abs(mode.bolster) == AT_JUMP
        or abs(mode.guide) == AT_JUMP
        or mode.direction == AT_JUMP
    )


@compiled
def branch(mode, axis):
    """Branch of column, bolster, guide or direction (axis 0 to 3)."""
    if axis == 0:
        return mode.column
    if axis == 1:
        return mode.bolster
    return mode.guide if axis == 2 else mode.direction


@compiled
def with_branch(mode, axis, value, p):
    """The mode with another branch of an axis; the time at rest runs while the column face does not slip."""
    column, bolster, guide, column_sign, bolster_sign, direction, stop, clock = mode
    if axis == 0:
        column = value
        if p.presliding_length == 0.0:
            clock = 0 if abs(value) == 1 else 1
    elif axis == 1:
        bolster = value
    elif axis == 2:
        guide = value
    else:
        direction = value
    return Mode(column, bolster, guide, column_sign, bolster_sign, direction, stop, clock)


@inlined
def with_signs(mode, column_sign, bolster_sign):
    """The mode with other signs of the normal forces."""
    return Mode(
        mode.column,
        mode.bolster,
        mode.guide,
        column_sign,
        bolster_sign,
        mode.direction,
        mode.stop,
        mode.clock,
    )


@compiled
def side(value, axis, higher):
    """Branch on the lower (0) or higher (1) side of the jump that holds an axis."""
    if axis == 3:
        return 2 * higher - 1
    return (0 if value > 0 else -1) + higher


@compiled
def beyond(mode, place, to_jump, p):
    """Mode behind a lower (even) or upper (odd) switch of an axis, or at the jump between both."""
    axis, upward = place // 2, place % 2
    now = branch(mode, axis)
    if abs(now) == AT_JUMP:
        return with_branch(mode, axis, side(now, axis, upward), p)
    if axis == 3:
        return with_branch(mode, axis, AT_JUMP if to_jump else -now, p)
    if axis == 0 and p.presliding_length > 0.0:
        return with_branch(mode, axis, -now, p)
    if to_jump:
        return with_branch(mode, axis, AT_JUMP if now + upward > 0 else -AT_JUMP, p)
    return with_branch(mode, axis, now + 2 * upward - 1, p)
