"""Forces on the mass, and their power.

    m x'' + c (x' - u') + k (x - u) + T = F

T is the friction of the rubbing surface, at the slip velocity v = x' - u', x' or x' - belt velocity. The
state holds the displacement against the base (x - u) where the mass rubs on the base, else x itself, so that
a mass that sticks has a constant velocity.
"""

from math import nan

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import (
    directional_friction,
    guide_friction,
    hooks,
    position_friction,
    presliding,
    series_compliance,
    states,
    travel,
)
from wedgesweep.excitation import acceleration, displacement, force, velocity
from wedgesweep.friction import lugre_bristles as bristles
from wedgesweep.systems.oscillator.modes import HELD, VELOCITY, X, crosses, slip, stuck


@states.measured_by("oscillator")
@inlined
def input_length(p):
    """What motions are compared with (m).

    The amplitude of the base; under a force the deflection that it causes at rest, or without a spring the
    motion of the free mass; without input the motion on the belt.
    """
    own, given = p.oscillator, p.input
    if given.amplitude == 0.0:
        fastest = max((own.spring / own.mass) ** 0.5, given.omega if own.spring == 0.0 else 0.0)
        return abs(own.belt_velocity) / fastest
    if own.forced:
        return given.amplitude / (own.spring if own.spring > 0.0 else own.mass * given.omega**2)
    return given.amplitude


@inlined
def elongation(t, y, p):
    """Elongation of the spring (m)."""
    if p.oscillator.absolute and not p.oscillator.forced:
        return y[X] - displacement(t, p)
    return y[X]


@inlined
def elongation_rate(t, y, p):
    """Its rate (m/s)."""
    if p.oscillator.absolute and not p.oscillator.forced:
        return y[VELOCITY] - velocity(t, p)
    return y[VELOCITY]


@inlined
def support(t, y, mode, p):
    """Force on the mass (N) of all that stands between it and the base."""
    stretch, rate = elongation(t, y, p), elongation_rate(t, y, p)
    spring = p.oscillator.spring
    springs = travel.force(stretch, mode.segment, spring, p) - spring * stretch
    return springs + damping(rate, y, mode, p) + hooks.force_on_mass(stretch, rate, y, p)


@inlined
def damping(rate, y, mode, p):
    """Force on the mass (N) of all dampers; none while a rod that they are behind crosses its play.

    Behind a spring they are part of ``friction_force``.
    """
    if series_compliance.acts(p):
        return 0.0
    if crosses(mode) and (p.oscillator.forced or not p.oscillator.absolute):
        return 0.0
    return hooks.damping(rate, y, p) - p.oscillator.damping * rate


@inlined
def applied(t, p):
    """Force of the input on the mass (N): the force itself, or inertia against a base that it rubs on."""
    if p.oscillator.forced:
        return force(t, p)
    if p.oscillator.absolute:
        return 0.0
    return -p.oscillator.mass * acceleration(t, p)


@inlined
def load(t, y, mode, p):
    """All forces on the mass (N) but friction."""
    return support(t, y, mode, p) + applied(t, p)


@inlined
def friction_force(y, mode, p):
    """Friction T (N) on a branch that no jump and no sticking holds, positive against positive slip."""
    return position_friction.scaled(_mean_friction(y, mode, p), y[X], p)


@inlined
def _mean_friction(y, mode, p):
    """Friction (N) as it is along the stroke on average."""
    if series_compliance.acts(p):
        return series_compliance.force(y, p)
    if crosses(mode):
        return 0.0
    rubbing, normal = slip(y, p), p.oscillator.normal_force
    factor = directional_friction.factor(mode.direction, p)
    if bristles.acts(p):
        return factor * bristles.force(rubbing, y, p)
    if presliding.acts(p):
        most = factor * p.friction.mu_d * normal + guide_friction.acts(p) * p.guide_friction.force
        return most * presliding.bristle(y, p)
    if p.friction.set_valued and mode.clock:
        coefficient = mode.column * friction.static(1, y, p)
    else:
        coefficient = friction.coefficient(rubbing, mode.column, friction.static(mode.clock, y, p), p)
    return factor * coefficient * normal - guide_friction.force(rubbing, mode.column, p)


@inlined
def resistance(now, y, mode, p):
    """Friction T (N) under the load ``now``: all of it where the mass keeps its velocity."""
    if stuck(mode, p) or abs(mode.column) == HELD:
        return now
    return friction_force(y, mode, p)


@inner
def powers(t, y, mode, p):
    """Power (W) that friction and dampers take, and power of the input and the belt; no normal forces."""
    own, pull = p.oscillator, support(t, y, mode, p)
    against = resistance(pull + applied(t, p), y, mode, p)
    rate = elongation_rate(t, y, p)
    taken = against * slip(y, p) - damping(rate, y, mode, p) * rate + hooks.power(rate, y, p)
    supplied = applied(t, p) * y[VELOCITY] - against * own.belt_velocity
    if own.absolute and not own.forced:
        supplied += pull * velocity(t, p)
    return taken, supplied, nan, nan
