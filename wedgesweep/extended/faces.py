"""Slip and friction coefficients of both faces, with every effect on them.

A face's own measure of slip is its velocity v in the plane, or with ``cross_slip`` the magnitude of the
whole: that measure decides on its branch. Equations in the effects' own files.
"""

from math import cos, exp, hypot, log1p

from wedgesweep.compiled import compiled, inlined
from wedgesweep.extended.mode import AGE, BRISTLE, COLUMN_VELOCITY, VELOCITY
from wedgesweep.friction.exponential import FLAT_BELOW

# A trial step may look past the end of a branch, where friction that falls with velocity would run away.
STRIBECK_FLAT = -1.0


@inlined
def column_slip(y, p):
    """Slip velocity of the column face (m/s)."""
    return p.column_ratio * y[VELOCITY] + p.column_slip_ratio * y[COLUMN_VELOCITY]


@inlined
def bolster_slip(y, p):
    """Slip velocity of the bolster face (m/s)."""
    return p.bolster_ratio * y[VELOCITY] + p.bolster_slip_ratio * y[COLUMN_VELOCITY]


@inlined
def cross_velocity(t, p):
    """Slip velocity (m/s) of both faces out of the plane."""
    if p.cross_slip_velocity == 0.0:
        return 0.0
    return p.cross_slip_velocity * cos(p.omega * t + p.cross_slip_phase)


@inlined
def static(y, mode, p):
    """Static coefficient after a time at rest; under a set-valued law the one that friction lets go at."""
    mu = p.static + p.stribeck_peak
    if p.set_valued and p.stribeck_velocity == 0.0:
        mu = p.dynamic
    if mode.clock and p.ageing_rate > 0.0:
        mu += p.ageing_rate * log1p(y[AGE] / p.ageing_time)
    return mu


@compiled
def sliding(speed, p):
    """Coefficient above the threshold velocity."""
    mu = p.dynamic
    if p.law == 2:
        mu *= max(speed / p.threshold_velocity, FLAT_BELOW) ** p.velocity_exponent
    if p.stribeck_velocity > 0.0:
        threshold = 0.0 if p.set_valued else p.threshold_velocity
        beyond = max((speed - threshold) / p.stribeck_velocity, STRIBECK_FLAT)
        mu += (p.static - p.dynamic + p.stribeck_peak) * exp(-beyond)
    return mu


@compiled
def coefficient(velocity, across, branch, clock, highest, p):
    """Signed coefficient of a face; ``highest`` is its static one, ``across`` its slip out of the plane."""
    if p.set_valued:
        return branch * (highest if clock else sliding(branch * velocity, p))
    if branch == 0:
        return highest * velocity / p.threshold_velocity
    if p.cross_slip_velocity == 0.0:
        return branch * sliding(branch * velocity, p)
    speed = max(hypot(velocity, across), 1e-3 * p.threshold_velocity)
    return sliding(speed, p) * velocity / speed


@compiled
def coefficients(t, y, mode, p):
    """Signed coefficients of column and bolster face, before they depend on the load."""
    across, highest = cross_velocity(t, p), static(y, mode, p)
    factor = 1.0 + p.directional_friction_asymmetry * mode.direction
    if p.presliding_length > 0.0:
        column = p.dynamic * y[BRISTLE]
    else:
        column = coefficient(column_slip(y, p), across, mode.column, mode.clock, highest, p)
    bolster = coefficient(bolster_slip(y, p), across, mode.bolster, mode.clock, highest, p)
    return factor * column, factor * bolster


@inlined
def bristle_rate(y, mode, p):
    """Rate of the bristle share (1/s); mode.column is the sign of the slip."""
    if p.presliding_length == 0.0:
        return 0.0
    slip = column_slip(y, p)
    return slip / p.presliding_length * (1.0 - y[BRISTLE] * mode.column)
