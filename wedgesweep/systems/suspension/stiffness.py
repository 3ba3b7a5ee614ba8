"""Where the suspension with effects is stiff: on a steep ramp of friction, and with short bristles.

The slip velocity of a face on a steep ramp settles within nanoseconds, which limits explicit steps.
"""

from math import sqrt

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import column_compliance, guide_friction, presliding, states
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.interface import implement
from wedgesweep.systems.suspension.faces import bolster_slip, column_slip
from wedgesweep.systems.suspension.modes import VELOCITY

# A record with this effect has all effects.
WITH_EFFECTS = "column_compliance"
# Steps for derivatives by differences: share of a state's size, and of a ramp for central ones by velocities.
STEP, ON_BOTH_SIDES = 1e-7, 1e-4
# Friction that settles this many times faster than the input is stiff.
STIFF = 2000.0
# First step on a ramp, as a share of the time in which a velocity settles there.
FIRST_STEP = 0.1


@implement(interface.stiff, WITH_EFFECTS)
@inlined
def stiff(mode, p):
    """Whether a face or the guide is on a ramp of friction that an explicit method could not follow."""
    on_ramp = mode.column == 0 or mode.bolster == 0 or (mode.guide == 0 and guide_friction.acts(p))
    steep = p.friction.mu_s * p.suspension.gravity > STIFF * p.input.omega * p.friction.v_t
    return on_ramp and steep and not p.friction.set_valued


@implement(interface.outruns, WITH_EFFECTS)
@inlined
def outruns(h, y, p):
    """Whether bristles settle so fast that they alone limit an explicit step."""
    return presliding.outruns(h, column_slip(y, p), p)


@implement(interface.settling_step, WITH_EFFECTS)
@inlined
def settling_step(p):
    """A step (s) that resolves how a face settles on its ramp after an event.

    A longer one may be accurate enough, but misses the motion away from the event.
    """
    return FIRST_STEP * p.friction.v_t / (p.friction.mu_s * p.suspension.gravity)


@implement(interface.perturbation, WITH_EFFECTS)
@inlined
def perturbation(place, y, p):
    """Step of a state for a derivative of the rate, and whether it goes to both sides.

    Along a ramp the rate is nonlinear, as normal forces depend on friction and friction on them. A much
    smaller step would be lost to rounding where velocities are large, and with it the order of the method.
    """
    if states.velocities(p)[place]:
        return ON_BOTH_SIDES * p.friction.v_t, True
    return STEP * max(states.scales(p)[place], abs(y[place])), False


@implement(interface.growth, WITH_EFFECTS)
@inner
def growth(by_state, p):
    """Rate (1/s) at which friction on its ramps drives the velocities of bolster and column apart.

    An implicit method would damp what in truth grows, and step across a wedge that locks.
    """
    column = column_compliance.velocity_place(p)
    a, b = by_state[VELOCITY, VELOCITY], by_state[VELOCITY, column]
    c, d = by_state[column, VELOCITY], by_state[column, column]
    return 0.5 * (a + d + sqrt(max((a - d) ** 2 + 4.0 * b * c, 0.0)))


@implement(interface.stiff_error, WITH_EFFECTS)
@inlined
def stiff_error(error, mode, p):
    """Largest error of a slip velocity on a ramp, over the width of the ramp."""
    column = abs(column_slip(error, p)) if mode.column == 0 else 0.0
    bolster = abs(bolster_slip(error, p)) if mode.bolster == 0 else 0.0
    return max(column, bolster) / p.friction.v_t
