"""Modes of unilateral joints in which both contacts surely carry load: those of bilateral joints.

They have the same equations there, and the same methods follow them: closed forms and power series.
"""

from wedgesweep.compiled import inlined, inner
from wedgesweep.systems.suspension.faces import coefficients
from wedgesweep.systems.suspension.modes import VELOCITY, held, stuck
from wedgesweep.systems.suspension.sticking import carries_load_until_breakaway
from wedgesweep.systems.suspension.unilateral.contacts import SINGULAR, regularity


@inlined
def are_unique(y, mode, p):
    """Whether closed contacts that slip are the only solution; elsewhere they never are.

    Principal minors of the problem are those of each face, which are positive here, and this determinant. If
    all are positive there is exactly one solution under any load (Samelson, Thrall and Wesler, 1958).
    """
    column_mu, bolster_mu = coefficients(0.0, y, mode, p)
    return regularity(column_mu, bolster_mu, p) > SINGULAR


@inner
def stays_closed(y, mode, p):
    """Whether a mode is one of bilateral joints: both contacts carry load, and it ends if one does not.

    Modes in which a jump of friction holds a velocity have no event functions for the normal forces. Nor have
    those in which the bolster sticks; but faces that carry load on the verge of slip in both directions carry
    load in between.
    """
    if not p.geometry.opens or mode.column_sign <= 0 or mode.bolster_sign <= 0 or held(mode):
        return False
    if not p.geometry.always_well_posed:
        slips = not p.friction.set_valued or (y[VELOCITY] != 0.0 and not stuck(mode, p))
        return slips and p.geometry.each_face_well_posed and are_unique(y, mode, p)
    return not stuck(mode, p) or carries_load_until_breakaway(y, mode.segment, p)
