"""Slip and friction coefficients of both wedge faces, with every effect on them.

The measure of slip of a face decides its branch: its velocity v in the plane, or with ``cross_slip`` the
magnitude of the whole slip velocity.
"""

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import column_compliance, cross_slip, directional_friction, presliding
from wedgesweep.systems.suspension.modes import BOLSTER, COLUMN, GUIDE, VELOCITY

# Least speeds to divide by, as shares of the threshold velocity.
SLOWEST, SLOWEST_RATE = 1e-3, 1e-12


@inlined
def column_slip(y, p):
    """Slip velocity of the column face (m/s)."""
    return p.geometry.column_ratio * y[VELOCITY] + _slip_by_column(p.geometry.column_slip_ratio, y, p)


@inlined
def bolster_slip(y, p):
    """Slip velocity of the bolster face (m/s)."""
    return p.geometry.bolster_ratio * y[VELOCITY] + _slip_by_column(p.geometry.bolster_slip_ratio, y, p)


@inlined
def _slip_by_column(ratio, y, p):
    """Part of a slip velocity (m/s) due to the motion of a compliant column, Q'."""
    return ratio * column_compliance.velocity(y, p) if column_compliance.acts(p) else 0.0


@inner
def _out_of_plane(slip, t, p):
    """Signed coefficient in the plane of a face that also slips out of the plane."""
    speed = max(cross_slip.speed(slip, t, p), SLOWEST * p.friction.v_t)
    return friction.sliding(speed, p) * slip / speed


@inlined
def _coefficient(slip, face, clock, highest, t, p):
    """Signed coefficient of a face on the branch ``face``; ``highest``: its static coefficient."""
    if p.friction.set_valued and clock:
        return face * highest
    if face != 0 and cross_slip.acts(p):
        return _out_of_plane(slip, t, p)
    return friction.coefficient(slip, face, highest, p)


@inlined
def coefficients(t, y, mode, p):
    """Signed coefficients of column and bolster face, before they depend on the load."""
    highest = friction.static(mode.clock, y, p)
    factor = directional_friction.factor(mode.direction, p)
    column = _coefficient(column_slip(y, p), mode.column, mode.clock, highest, t, p)
    bolster = _coefficient(bolster_slip(y, p), mode.bolster, mode.clock, highest, t, p)
    return factor * presliding.coefficient(column, y, p), factor * bolster


@inlined
def slip_measure(axis, t, y, p):
    """Measure of slip (m/s) that decides the branch of an axis."""
    if axis >= GUIDE:
        return y[VELOCITY]
    return cross_slip.speed(column_slip(y, p) if axis == COLUMN else bolster_slip(y, p), t, p)


@inner
def slip_rate(axis, t, y, acceleration, column_acceleration, p):
    """Rate of an axis's measure of slip (m/s^2)."""
    if axis >= GUIDE:
        return acceleration
    g = p.geometry
    rate = g.column_ratio * acceleration
    slip = column_slip(y, p)
    by_column = g.column_slip_ratio
    if axis == BOLSTER:
        rate, slip, by_column = g.bolster_ratio * acceleration, bolster_slip(y, p), g.bolster_slip_ratio
    if column_compliance.acts(p):
        rate += by_column * column_acceleration
    if not cross_slip.acts(p):
        return rate
    across = cross_slip.velocity(t, p)
    speed = max(cross_slip.speed(slip, t, p), SLOWEST_RATE * p.friction.v_t)
    return (slip * rate + across * cross_slip.acceleration(t, p)) / speed
