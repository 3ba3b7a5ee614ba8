"""Unilateral joints while both contacts are closed: then they are bilateral ones, which follow them faster.

Records of bilateral joints that are marked so follow a motion as long as both contacts surely carry load, and
hand it over to the system of ``unilateral/`` where one opens, or may open.
"""

from wedgesweep.compiled import inlined
from wedgesweep.hybrid.interface import implement, leaves, taken_over
from wedgesweep.systems.suspension.modes import held, mode_of, stuck
from wedgesweep.systems.suspension.release import is_known

MARK = "while_closed"


@inlined
def stays_closed(y, mode, p):
    """Whether bilateral joints tell when a contact opens: each is loaded, and its force is watched.

    While a jump of friction holds a velocity they do not watch the normal forces. Nor do they while the
    bolster sticks; but if both faces carry load on the verge of slip in either direction, they do in between.
    """
    loaded = mode.column_sign > 0 and mode.bolster_sign > 0 and not held(mode)
    if not (loaded and p.geometry.always_well_posed):
        return False
    return not stuck(mode, p) or is_known(y, mode.segment, p)


@implement(leaves, MARK)
@inlined
def may_open(y, mode, p):
    """Whether a contact of joints that can open does so, or may."""
    return p.geometry.opens != 0 and not stays_closed(y, mode, p)


@implement(taken_over, MARK)
@inlined
def has_closed(t, y, mode, p):
    """The same mode: the system of ``unilateral/`` has found it."""
    return mode_of(mode), True
