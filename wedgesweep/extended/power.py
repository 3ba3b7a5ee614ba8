"""Power in the frame of the table: what friction and damping take, what the base supplies."""

from wedgesweep.compiled import compiled
from wedgesweep.effects import guide_friction, viscous_damping
from wedgesweep.extended.faces import bolster_slip, coefficients, column_slip
from wedgesweep.extended.mode import COLUMN_VELOCITY, FRAME_VELOCITY, VELOCITY


@compiled
def friction_power(t, y, mode, now, p):
    """Power (W) that friction takes on all faces, from the forces ``now``."""
    column_mu, bolster_mu = coefficients(t, y, mode, p)
    column, bolster = abs(now.column), abs(now.bolster)
    if p.load_dependent_friction_exponent != 0.0:
        reference, exponent = p.load_dependent_friction_reference, p.load_dependent_friction_exponent
        column = reference**exponent * column ** (1.0 - exponent)
        bolster = reference**exponent * bolster ** (1.0 - exponent)
    faces = column_mu * column * column_slip(y, p) + bolster_mu * bolster * bolster_slip(y, p)
    return 2.0 * faces - guide_friction.force(y[VELOCITY], mode.guide, p) * y[VELOCITY]


@compiled
def damping_power(y, p):
    """Power (W) that the dampers of bolster, columns and side frame take."""
    viscous = -viscous_damping.force(y[VELOCITY], p) * y[VELOCITY]
    columns = 2.0 * p.column_damping * y[COLUMN_VELOCITY] ** 2
    return viscous + columns + p.fixture_damping * y[FRAME_VELOCITY] ** 2


@compiled
def supplied_power(base, y, p):
    """Power (W) of the inertia forces of the table's acceleration ``base``."""
    velocity, frame = y[VELOCITY], y[FRAME_VELOCITY]
    lifted = p.column_ratio * p.cos_column * velocity + p.lift_ratio * y[COLUMN_VELOCITY]
    momentum = p.side_frame_mass * frame + p.bolster_mass * (velocity + frame)
    momentum += 2.0 * p.wedge_mass * (lifted + frame)
    return -base * momentum
