"""Where the suspension with effects is stiff: on a steep ramp of friction, and under short bristles.

A face that a steep ramp all but holds answers within nanoseconds; an explicit step could not be longer
than that.
"""

from math import sqrt

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import column_compliance, guide_friction, presliding, states
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.interface import implement
from wedgesweep.systems.suspension.faces import bolster_slip, column_slip
from wedgesweep.systems.suspension.modes import VELOCITY

# The kit of records that has all effects is known by this one.
WITH_EFFECTS = "column_compliance"
# Share of a state's size by which it is moved for a derivative, and of a ramp on both sides of a velocity.
STEP, ON_BOTH_SIDES = 1e-7, 1e-4
# Friction that answers this many times faster than the input is stiff.
STIFF = 2000.0
# Part of the time in which a ramp lets a velocity settle.
FIRST = 0.1


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
    """Whether bristles answer so fast that they alone limit an explicit step."""
    return presliding.outruns(h, column_slip(y, p), p)


@implement(interface.settling_step, WITH_EFFECTS)
@inlined
def settling_step(p):
    """A step (s) that resolves how a face settles on its ramp after an event.

    A longer one may be accurate enough but looks past that, and then sees no motion away from the event.
    """
    return FIRST * p.friction.v_t / (p.friction.mu_s * p.suspension.gravity)


@implement(interface.perturbation, WITH_EFFECTS)
@inlined
def perturbation(place, y, p):
    """Step of a state for a derivative of the rate, and whether it goes to both sides.

    A ramp bends within its own width, as normal forces depend on friction and friction on them. A smaller
    step there is lost in velocities that are large: then the order of the method is, too.
    """
    if states.velocities(p)[place]:
        return ON_BOTH_SIDES * p.friction.v_t, True
    return STEP * max(states.scales(p)[place], abs(y[place])), False


@implement(interface.growth, WITH_EFFECTS)
@inner
def growth(by_state, p):
    """Rate (1/s) at which friction on its ramps drives the velocities of bolster and column apart.

    An implicit method would damp what in truth runs away, and step over a wedge that locks.
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
