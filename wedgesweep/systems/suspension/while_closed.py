"""Unilateral joints while both contacts are closed: bilateral joints then have the same equations.

Their state is smaller, and they are faster. Records of bilateral joints with the field MARK follow a motion
as long as both contacts surely carry load. They hand it over to the system of ``unilateral/`` where a contact
opens, or may open, and where more than one state of the contacts may be possible.
"""

from wedgesweep.compiled import inlined, inner
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.interface import implement
from wedgesweep.systems.suspension import transitions
from wedgesweep.systems.suspension.faces import coefficients
from wedgesweep.systems.suspension.modes import VELOCITY, held, mode_of, stuck, with_signs
from wedgesweep.systems.suspension.sticking import carries_load_until_breakaway
from wedgesweep.systems.suspension.unilateral.contacts import minors

MARK = "while_closed"


@inlined
def _are_unique(y, mode, p):
    """Whether closed contacts that slip are the only solution; elsewhere they never are, see ``minors``.

    Each contact alone never locks here.
    """
    column_mu, bolster_mu = coefficients(0.0, y, mode, p)
    return minors(column_mu, bolster_mu, p)[2] > 0.0


@inlined
def stays_closed(y, mode, p):
    """Whether bilateral joints can follow a mode: both contacts carry load, and it ends if one does not.

    Modes in which a jump of friction holds a velocity have no event functions for the normal forces. Nor have
    those in which the bolster sticks; but faces that carry load on the verge of slip in both directions carry
    load in between.
    """
    if mode.column_sign <= 0 or mode.bolster_sign <= 0 or held(mode):
        return False
    if not p.geometry.always_well_posed:
        slips = not p.friction.set_valued or (y[VELOCITY] != 0.0 and not stuck(mode, p))
        return slips and p.geometry.each_face_well_posed and _are_unique(y, mode, p)
    return not stuck(mode, p) or carries_load_until_breakaway(y, mode.segment, p)


@implement(interface.leaves, MARK)
@inlined
def may_open(y, mode, p):
    """Whether a contact of joints that can open does so, or may."""
    return p.geometry.opens != 0 and not stays_closed(y, mode, p)


@implement(interface.taken_over, MARK)
@inlined
def has_closed(t, y, mode, p):
    """The mode that the system of ``unilateral/`` has found, as a tuple."""
    return mode_of(mode), True


# Joints that can open lock where bilateral ones do not, and the other way round: a normal force that pulls is
# no solution. Where bilateral joints know of none or of several modes, the other system has to find it.


@inlined
def _known(mode, unique, p):
    """The mode and whether it is unique; signs of 0 if only the other system can tell."""
    if unique or not p.geometry.opens:
        return mode, unique
    return with_signs(mode, 0, 0), True


@implement(interface.initial_mode, MARK)
@inner
def initial_mode(t, y, p):
    """Mode in which a run begins, and whether it is unique."""
    mode, unique = transitions.initial_mode(t, y, p)
    return _known(mode, unique, p)


@implement(interface.transition, MARK)
@inner
def transition(t, y, mode, place, p):
    """State and mode after an event, and whether they are unique."""
    y, found, certain = transitions.transition(t, y, mode, place, p)
    found, unique = _known(found, certain, p)
    return y, found, unique


@implement(interface.well_posed, MARK)
@inner
def well_posed(t, y, mode, p):
    """Whether exactly one state of the contacts is possible."""
    if p.geometry.opens:
        return p.geometry.always_well_posed or _are_unique(y, mode, p)
    return transitions.well_posed(t, y, mode, p)
