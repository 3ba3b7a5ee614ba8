"""Contact modes of the suspension: which smooth piece of its equations holds."""

from typing import NamedTuple

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import directional_friction, presliding
from wedgesweep.hybrid.vectors import replaced

# Displacement x from the frictionless equilibrium (m) and its rate: the first two states.
X, VELOCITY = 0, 1
# Friction axes: velocities that a jump of friction can hold. Their branches are the first numbers of a mode,
# and each has two event functions, for the lower and the upper end of its branch.
COLUMN, BOLSTER, GUIDE, DIRECTION = range(4)
AXES = 4
# Places of the other numbers of a mode.
COLUMN_SIGN, BOLSTER_SIGN, SEGMENT, CLOCK = range(AXES, AXES + 4)
# Branch of an axis whose slip velocity a jump at +-v_t holds (Filippov), with the sign of that velocity.
HELD = 2


class ContactMode(NamedTuple):
    """Which smooth piece of the equations holds.

    ``column``, ``bolster``, ``guide``: slip branch (-1, 0, 1, or +-HELD) of each face; 0 is stuck under a
    set-valued law. ``direction``: sign of z' where friction depends on it, HELD where its jump holds the
    bolster, else 0. ``column_sign``, ``bolster_sign``: signs of the normal forces; the joints are bilateral
    and friction acts with |N|. ``segment`` of the travel: see effects/travel.py. ``clock``: 1 while the time
    at rest runs.
    """

    column: int
    bolster: int
    guide: int
    direction: int
    column_sign: int
    bolster_sign: int
    segment: int
    clock: int


@inlined
def stuck(mode, p):
    """Whether set-valued friction holds the bolster."""
    return p.friction.set_valued and mode.column == 0


@inlined
def held(mode):
    """Whether the jump of a friction law holds a velocity."""
    found = False
    for axis in range(AXES):
        found = found or abs(mode[axis]) == HELD
    return found


@inlined
def with_branch(mode, axis, value, p):
    """The mode with another branch of an axis; the time at rest runs while the column face does not slip."""
    if axis == COLUMN and not presliding.acts(p):
        mode = replaced(mode, CLOCK, 0 if abs(value) == 1 else 1)
    return replaced(mode, axis, value)


@inlined
def with_signs(mode, column_sign, bolster_sign):
    """The mode with other signs of the normal forces."""
    return replaced(replaced(mode, COLUMN_SIGN, column_sign), BOLSTER_SIGN, bolster_sign)


@inner
def slipping(direction, segment, clock, p):
    """Mode of slip in a direction (sign of z') under a set-valued law; ``clock`` = 1: on its verge."""
    ratio = p.geometry.bolster_ratio
    bolster = direction if ratio > 0.0 else -direction
    if ratio == 0.0:
        bolster = 0
    sign = direction if directional_friction.acts(p) else 0
    return ContactMode(direction, bolster, direction, sign, 1, 1, segment, clock)


@inlined
def side(value, axis, higher):
    """Branch on the lower (0) or higher (1) side of the jump that holds an axis on the branch ``value``."""
    if axis == DIRECTION:
        return 2 * higher - 1
    return (0 if value > 0 else -1) + higher


@inner
def next_branch(mode, place, to_jump, p):
    """Mode after a lower (even) or upper (odd) event of an axis: the next branch, or held at the jump."""
    axis, upward = place // 2, place % 2
    now = mode[axis]
    if abs(now) == HELD:
        value = side(now, axis, upward)
    elif axis == DIRECTION:
        value = HELD if to_jump else -now
    elif axis == COLUMN and presliding.acts(p):
        value = -now
    elif to_jump:
        value = HELD if now + upward > 0 else -HELD
    else:
        value = now + 2 * upward - 1
    return with_branch(mode, axis, value, p)
