"""Unilateral joints while both contacts are closed: bilateral joints then have the same equations.

Their state is smaller, and they are faster. Records of bilateral joints with the field MARK follow a motion
as long as both contacts surely carry load. They hand it over to the system of ``unilateral/`` where a contact
opens, or may open.
"""

from wedgesweep.compiled import inlined
from wedgesweep.hybrid.interface import implement, leaves, taken_over
from wedgesweep.systems.suspension.breakaway import carries_load_until_breakaway
from wedgesweep.systems.suspension.modes import held, mode_of, stuck

MARK = "while_closed"


@inlined
def stays_closed(y, mode, p):
    """Whether bilateral joints can follow a mode: both contacts carry load, and it ends if one does not.

    Modes in which a jump of friction holds a velocity have no event functions for the normal forces. Nor have
    those in which the bolster sticks; but faces that carry load on the verge of slip in both directions carry
    load in between.
    """
    loaded = mode.column_sign > 0 and mode.bolster_sign > 0 and not held(mode)
    if not (loaded and p.geometry.always_well_posed):
        return False
    return not stuck(mode, p) or carries_load_until_breakaway(y, mode.segment, p)


@implement(leaves, MARK)
@inlined
def may_open(y, mode, p):
    """Whether a contact of joints that can open does so, or may."""
    return p.geometry.opens != 0 and not stays_closed(y, mode, p)


@implement(taken_over, MARK)
@inlined
def has_closed(t, y, mode, p):
    """The mode that the system of ``unilateral/`` has found, as a tuple."""
    return mode_of(mode), True
