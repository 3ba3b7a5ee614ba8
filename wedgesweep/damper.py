"""Mechanics of the wedge suspension: the only place that knows Newton.

Half model of one bolster, two mirror-image wedges and a driven side frame; see PHYSICS.md for the
derivation. State: deflection x = z - z_rest of the bolster against the side frame (z = y - u, up
positive, z_rest its frictionless equilibrium) and its rate. With both contacts closed a wedge travels
s = r z along the column and slips at r z' on the column face and at q z' on the bolster face.
"""

from collections.abc import Callable
from math import cos, sin, sqrt
from typing import NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import compiled, inlined
from wedgesweep.effects import guide_friction

# Code of the law whose coefficient grows without bound if its exponent is positive.
EXPONENTIAL = friction.LAW_NAMES.index("exponential")
# Fields of effects for which ``never_locks`` has no proof: no bound is known for their friction.
UNPROVED = ("ageing_rate", "load_dependent_friction_exponent")


class Contact(NamedTuple):
    """Which smooth piece of the equations holds.

    ``column``, ``bolster``, ``guide``: slip branch (-1, 0, 1) of each face; 0 is stuck under a
    set-valued law. ``column_sign``, ``bolster_sign``: signs (-1, 1) of the normal forces; the joints are
    bilateral and friction acts with |N|.
    """

    column: int
    bolster: int
    guide: int
    column_sign: int
    bolster_sign: int


class Forces(NamedTuple):
    """Acceleration z'' (m/s^2) and the normal forces on both faces (N), compression positive."""

    acceleration: float
    column: float
    bolster: float


def prepare(p) -> None:
    """Fill in the geometry and the rest position of a parameter record, in place.

    Whether an extended one never locks is for extended.rest to say, which knows all degrees of freedom.
    """
    included = p["wedge_angle"] + p["column_angle"]
    p["sin_wedge"], p["cos_wedge"] = sin(p["wedge_angle"]), cos(p["wedge_angle"])
    p["sin_column"], p["cos_column"] = sin(p["column_angle"]), cos(p["column_angle"])
    p["sin_included"], p["cos_included"] = sin(included), cos(included)
    p["column_ratio"] = p["sin_wedge"] / p["sin_included"]
    p["bolster_ratio"] = -p["sin_column"] / p["sin_included"]
    if not p["extended"]:
        p["never_locks"] = never_locks(determinant, p)
    p["rest"] = p["column_rest"] = 0.0
    p["rest"] = -frictionless(0.0, 0.0, p).acceleration / frictionless_stiffness(p)


@inlined
def reactions(along, into, vertical, column_mu, bolster_mu, p):
    """Solve Newton's three equations for z'' and the normal forces.

    ``along`` and ``into`` are the loads on a wedge along and into the column, ``vertical`` the load on
    the bolster (N), all without contact forces; the coefficients carry the sign of their normal
    force, so that the equations are linear:

        M_w r z'' + mu_c N_c + N_b (sin(a+g) + mu_b cos(a+g)) = along
                         N_c - N_b (cos(a+g) - mu_b sin(a+g)) = into
              M_b z'' - 2 N_b (sin a + mu_b cos a)            = vertical
    """
    lift = p.sin_wedge + bolster_mu * p.cos_wedge
    normal = p.cos_included - bolster_mu * p.sin_included
    inertia = p.wedge_mass * p.column_ratio / p.bolster_mass
    driving = along - column_mu * into - inertia * vertical
    bolster = driving / determinant(column_mu, bolster_mu, p)
    return Forces((vertical + 2.0 * bolster * lift) / p.bolster_mass, into + bolster * normal, bolster)


def never_locks(determinant: Callable, p) -> bool:
    """Whether every load has exactly one pair of normal forces, at any slip velocity.

    ``determinant`` of Newton's equations, a function of both signed coefficients and p, positive
    without friction.

    Newton's equations with |N| are linear on each quadrant of (N_c, N_b), and such a map is one-to-one
    if and only if its four determinants have the same sign (Samelson, Thrall and Wesler, 1958). They
    are linear in each coefficient of friction, so that the extreme coefficients decide.
    """
    if p["law"] == EXPONENTIAL and p["velocity_exponent"] > 0.0:
        return False
    most = p["dynamic"] if p["set_valued"] else max(p["dynamic"], p["static"])
    if p["extended"]:
        if any(p[name] != 0.0 for name in UNPROVED):
            return False
        most = max(p["dynamic"], p["static"] + p["stribeck_peak"])
        most *= 1.0 + abs(p["directional_friction_asymmetry"])
    corners = ((most, most), (most, -most), (-most, most), (-most, -most))
    return all(determinant(column, bolster, p) > 0.0 for column, bolster in corners)


@inlined
def determinant(column_mu, bolster_mu, p):
    """Determinant of Newton's equations in ``reactions``, over that of the masses."""
    lift = p.sin_wedge + bolster_mu * p.cos_wedge
    tangential = p.sin_included + bolster_mu * p.cos_included
    normal = p.cos_included - bolster_mu * p.sin_included
    inertia = p.wedge_mass * p.column_ratio / p.bolster_mass
    return tangential + column_mu * normal + 2.0 * inertia * lift


@inlined
def loads(x, velocity, base_acceleration, guide_branch, p):
    """Loads on wedge (along and into the column) and bolster for ``reactions``."""
    z = p.rest + x
    weight = p.gravity + base_acceleration
    spring = p.wedge_preload - p.wedge_spring * p.column_ratio * p.cos_column * z
    wedge = spring - p.wedge_mass * weight
    guide = guide_friction.force(velocity, guide_branch, p)
    bolster = guide - p.bolster_spring * z - p.bolster_mass * weight
    return wedge * p.cos_column, wedge * p.sin_column, bolster


@inlined
def forces(x, velocity, base_acceleration, contact, p):
    """Acceleration and normal forces on the given smooth piece of the equations."""
    along, into, vertical = loads(x, velocity, base_acceleration, contact.guide, p)
    column_mu = friction.coefficient(p.column_ratio * velocity, contact.column, p)
    bolster_mu = friction.coefficient(p.bolster_ratio * velocity, contact.bolster, p)
    return reactions(
        along, into, vertical, contact.column_sign * column_mu, contact.bolster_sign * bolster_mu, p
    )


@compiled
def spring_response(column_mu, bolster_mu, p):
    """Derivatives of z'' and the normal forces with respect to x at fixed friction coefficients."""
    wedge = -p.wedge_spring * p.column_ratio * p.cos_column
    return reactions(wedge * p.cos_column, wedge * p.sin_column, -p.bolster_spring, column_mu, bolster_mu, p)


@compiled
def stiffness_and_damping(x, velocity, base_acceleration, contact, p):
    """Derivatives of z'' with respect to x and to x' (the analytic Jacobian).

    The equations are linear in the reactions, so each derivative is ``reactions`` itself with the
    derivative of the loads: of the springs for x, of the friction coefficients for x'.
    """
    column_slip, bolster_slip = p.column_ratio * velocity, p.bolster_ratio * velocity
    column_mu = contact.column_sign * friction.coefficient(column_slip, contact.column, p)
    bolster_mu = contact.bolster_sign * friction.coefficient(bolster_slip, contact.bolster, p)
    by_x = spring_response(column_mu, bolster_mu, p)
    column_slope = contact.column_sign * p.column_ratio * friction.slope(column_slip, contact.column, p)
    bolster_slope = contact.bolster_sign * p.bolster_ratio * friction.slope(bolster_slip, contact.bolster, p)
    now = forces(x, velocity, base_acceleration, contact, p)
    by_velocity = reactions(
        -column_slope * now.column - bolster_slope * now.bolster * p.cos_included,
        -bolster_slope * now.bolster * p.sin_included,
        guide_friction.slope(contact.guide, p) + 2.0 * bolster_slope * now.bolster * p.cos_wedge,
        column_mu,
        bolster_mu,
        p,
    )
    return by_x.acceleration, by_velocity.acceleration


@compiled
def frictionless(x, base_acceleration, p):
    """Acceleration and normal forces with friction taken away on every face."""
    along, into, vertical = loads(x, 0.0, base_acceleration, 0, p)
    return reactions(along, into, vertical, 0.0, 0.0, p)


@compiled
def frictionless_stiffness(p):
    """Derivative of the frictionless z'' with respect to x (1/s^2), negative."""
    return spring_response(0.0, 0.0, p).acceleration


def resonance(p) -> float:
    """Angular frequency (rad/s) of the frictionless suspension."""
    return sqrt(-frictionless_stiffness(p))
