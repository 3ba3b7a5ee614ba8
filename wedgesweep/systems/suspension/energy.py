"""Power of friction, of damping and of the base, in the frame of the table (of the base motion u)."""

from wedgesweep.compiled import inlined
from wedgesweep.effects import (
    column_compliance,
    fixture_resonance,
    guide_friction,
    hooks,
    load_dependent_friction,
)
from wedgesweep.systems.suspension.faces import bolster_slip, coefficients, column_slip
from wedgesweep.systems.suspension.modes import VELOCITY


@inlined
def friction_power(t, y, mode, now, p):
    """Power (W) that friction takes on all faces and on the guide, under the forces ``now``."""
    column_mu, bolster_mu = coefficients(t, y, mode, p)
    column = load_dependent_friction.coefficient(column_mu, now.column, p) * abs(now.column)
    bolster = load_dependent_friction.coefficient(bolster_mu, now.bolster, p) * abs(now.bolster)
    faces = column * column_slip(y, p) + bolster * bolster_slip(y, p)
    return 2.0 * faces - guide_friction.force(y[VELOCITY], mode.guide, p) * y[VELOCITY]


@inlined
def damping_power(y, p):
    """Power (W) that all dampers take."""
    velocity = y[VELOCITY]
    return hooks.power(velocity, y, p) - hooks.damping(velocity, y, p) * velocity


@inlined
def supplied_power(base, y, p):
    """Power (W) of the inertia forces of the table's acceleration ``base``."""
    s, g, velocity = p.suspension, p.geometry, y[VELOCITY]
    rising = g.column_ratio * g.cos_column * velocity
    if column_compliance.acts(p):
        rising += g.lift_ratio * column_compliance.velocity(y, p)
    momentum = s.bolster_mass * velocity + 2.0 * s.wedge_mass * rising
    if fixture_resonance.acts(p):
        carried = s.side_frame_mass + s.bolster_mass + 2.0 * s.wedge_mass
        momentum += carried * fixture_resonance.velocity(y, p)
    return -base * momentum
