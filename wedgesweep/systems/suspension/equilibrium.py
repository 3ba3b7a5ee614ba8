"""Equilibrium and resonance of the suspension without friction."""

from math import nan, sqrt

import numpy as np

from wedgesweep.compiled import compiled, inlined, inner
from wedgesweep.effects import column_compliance, cubic_stiffness
from wedgesweep.systems.suspension.newton import (
    NO_FRICTION,
    Coefficients,
    Loads,
    reactions,
    spring_forces,
)

ITERATIONS = 100
# Newton's method ends at steps of this share of the deflection of the bolster's spring by weight and preload.
REACHED = 1e-12


@compiled
def determinant(column_mu, bolster_mu, p):
    """Determinant of Newton's equations, positive without friction."""
    unloaded = Loads(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return -reactions(unloaded, Coefficients(column_mu, bolster_mu, 0.0, 0.0), p)[1]


@inner
def _response(wedge, vertical, lateral, p):
    """Accelerations z'' and Q'' under forces (N) on wedge and bolster (up) and column (outward).

    In equilibrium the side frame does not accelerate either, so that a compliant fixture changes nothing.
    """
    g = p.geometry
    load = Loads(wedge * g.cos_column, wedge * g.sin_column, vertical, lateral, 0.0, 0.0)
    now = reactions(load, NO_FRICTION, p)[0]
    return now.acceleration, now.column_acceleration


@inlined
def _by_displacement(p):
    """Change (N/m) of the forces on wedge and bolster by z, without effects."""
    s, g = p.suspension, p.geometry
    wedge = -s.wedge_spring * (g.column_ratio * g.cos_column - g.spring_on_bolster)
    return wedge, -s.bolster_spring - 2.0 * g.spring_on_bolster * wedge


@compiled
def equilibrium(p):
    """Frictionless equilibrium z and Q (m), by Newton's method; NaN if there is none, or no stable one.

    ``rz``, ``rq``: z'' and Q'' that are left; ``zz``, ``zq``, ``qz``, ``qq``: derivatives of z'' and Q'' by z
    and Q, such as ``qz`` of Q'' by z.
    """
    s, g = p.suspension, p.geometry
    lift, on_bolster = g.column_ratio * g.cos_column, g.spring_on_bolster
    (wedge_by_z, bolster_by_z), wedge_by_q = _by_displacement(p), -s.wedge_spring * g.lift_ratio
    cubic = cubic_stiffness.coefficient(p)
    yields, stiffness = column_compliance.acts(p), column_compliance.stiffness(p)
    close = REACHED * (s.bolster_mass * s.gravity + abs(s.wedge_preload)) / s.bolster_spring
    z, deflection = 0.0, 0.0
    for _ in range(ITERATIONS):
        wedge, reaction = spring_forces(lift * z + g.lift_ratio * deflection, z, p)
        vertical = -(s.bolster_spring + cubic * z * z) * z - s.bolster_mass * s.gravity + reaction
        lateral = -stiffness * deflection
        rz, rq = _response(wedge - s.wedge_mass * s.gravity, vertical, lateral, p)
        zz, qz = _response(wedge_by_z, bolster_by_z - 3.0 * cubic * z * z, 0.0, p)
        if not yields:
            dz, dq, stable = -rz / zz, 0.0, zz < 0.0
        else:
            zq, qq = _response(wedge_by_q, -2.0 * on_bolster * wedge_by_q, -stiffness, p)
            jacobian = zz * qq - zq * qz
            dz, dq = -(rz * qq - zq * rq) / jacobian, -(zz * rq - rz * qz) / jacobian
            stable = zz < 0.0 and jacobian > 0.0
        z, deflection = z + dz, deflection + dq
        if abs(dz) + abs(dq) <= close:
            return (z, deflection) if stable else (nan, nan)
    return nan, nan


@compiled
def _acceleration_per_displacement(p):
    """Derivative of z'' by z (1/s^2), without friction and effects."""
    wedge, bolster = _by_displacement(p)
    return _response(wedge, bolster, 0.0, p)[0]


def resonance(p: np.void) -> float:
    """Angular frequency (rad/s) of the suspension without friction and effects."""
    return sqrt(-_acceleration_per_displacement(p))
