"""Newton's equations of the wedge suspension: accelerations and normal forces on a smooth piece.

Half model of one bolster, two mirror-image wedges and a driven side frame, derived in docs/physics.md.
State: displacement x = z - z_rest of the bolster against the side frame (z = y - u, up positive, z_rest
its frictionless equilibrium) and its rate. With w the wedge's displacement against the side frame, w = A_t
t_c + Q cos g n_c, and both contacts closed (Q: displacement of a column that yields, else 0):

    A_t = r z + Q cos g cot(a+g)         w_z = r cos g z + Q cos g cos a/sin(a+g)
    v_c = r z' + Q' cos a/sin(a+g)       v_b = q z' + Q' cos g/sin(a+g)

Unknown are z'', Q'', the side frame's own acceleration A and both normal forces; the accelerations are
linear in the forces, which leaves two equations for these. Friction T = mu |N| is written as T = tau + m N,
with tau = 0 where the coefficient does not depend on the load, and as a tangent where it does.
"""

from math import nan
from typing import NamedTuple

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import (
    column_compliance,
    fixture_resonance,
    guide_friction,
    hooks,
    load_dependent_friction,
    travel,
)
from wedgesweep.excitation import acceleration
from wedgesweep.systems.shared import ROUNDING
from wedgesweep.systems.suspension.faces import coefficients
from wedgesweep.systems.suspension.modes import VELOCITY, X, with_signs

# Newton's method for coefficients that depend on the load: most iterations, and the relative change of each
# normal force at which it ends, as the error is squared in each iteration. Near lift-off one force is no more
# than rounding error: then the changes together must be below the last number times both forces.
LOAD_ITERATIONS, LAST_CHANGE, LIFT_OFF_CHANGE = 40, 1e-7, 1e-11


class Forces(NamedTuple):
    """What follows from a state in a mode: accelerations (m/s^2) and normal forces (N).

    z'' of the bolster, Q'' of a column, d'' of the side frame against its table, and the normal forces
    on column and bolster face, compression positive.
    """

    acceleration: float
    column_acceleration: float
    frame_acceleration: float
    column: float
    bolster: float


class Accelerations(NamedTuple):
    """Accelerations of the effects' own degrees of freedom (m/s^2)."""

    column: float
    frame: float


class Loads(NamedTuple):
    """Loads (N) without contact forces, and without the inertia of the side frame's acceleration.

    On a wedge tangential and normal to the column, on the bolster, on a column (lateral, outward), on the
    side frame from its table; ``base`` is the table's acceleration (m/s^2).
    """

    tangential: float
    normal: float
    vertical: float
    lateral: float
    frame: float
    base: float


class Coefficients(NamedTuple):
    """Friction T = tau + mu N of both faces; mu carries the sign of the normal force."""

    column: float
    bolster: float
    column_tau: float
    bolster_tau: float


class Closed(NamedTuple):
    """Constants of the equations of a wedge between two closed contacts; mu is that of the bolster face.

    Per N_b, along the column: ``along`` + ``along_mu`` mu, normal to it ``into`` + ``into_mu`` mu, and z'' by
    ``push`` + ``push_mu`` mu (1/kg). ``mobility``: z'' per force on the bolster (1/kg), ``inertia``: force of
    a wedge along the column per force on the bolster; ``along_base``, ``into_base``: force of a wedge per
    acceleration of the side frame (kg).
    """

    along: float
    along_mu: float
    into: float
    into_mu: float
    push: float
    push_mu: float
    mobility: float
    inertia: float
    along_base: float
    into_base: float


NO_FRICTION = Coefficients(0.0, 0.0, 0.0, 0.0)
UNDETERMINED = Forces(nan, nan, nan, nan, nan)
# Loads while the side frame accelerates by 1 m/s^2.
UNIT_BASE = Loads(0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


@inlined
def _rise(z, y, p):
    """Rise of a wedge (m), which its spring feels."""
    rise = p.geometry.column_ratio * p.geometry.cos_column * z
    if column_compliance.acts(p):
        rise += p.geometry.lift_ratio * column_compliance.displacement(y, p)
    return rise


@inlined
def spring_forces(rise, z, p):
    """Force (N, up positive) of a wedge's spring on the wedge, and of both wedges' springs on the bolster.

    They stand on the side frame (variable damping), or on the bolster (constant damping); the wedge has risen
    by ``rise``, the bolster by ``z`` (m).
    """
    s, on_bolster = p.suspension, p.geometry.spring_on_bolster
    force = s.wedge_preload - s.wedge_spring * (rise - on_bolster * z)
    return force, -2.0 * on_bolster * force


@inlined
def applied_forces(rise, y, segment, guide, p):
    """Forces (N, up positive) on a wedge that has risen by ``rise`` (m) and on the bolster, but for contacts.

    ``segment`` of the travel of the bolster, and its slip branch in the ``guide``.
    """
    s, z, velocity = p.suspension, p.geometry.rest + y[X], y[VELOCITY]
    spring, reaction = spring_forces(rise, z, p)
    bolster = hooks.force_on_mass(z, velocity, y, p) + hooks.damping(velocity, y, p)
    bolster += travel.force(y[X], segment, s.bolster_spring, p)
    bolster -= s.bolster_spring * z + s.bolster_mass * s.gravity
    bolster += guide_friction.force(velocity, guide, p)
    return spring - s.wedge_mass * s.gravity, bolster + reaction


@inlined
def loads(t, y, mode, p):
    """Loads at a state; see ``Loads``."""
    g = p.geometry
    wedge, bolster = applied_forces(_rise(g.rest + y[X], y, p), y, mode.segment, mode.guide, p)
    return Loads(
        wedge * g.cos_column,
        wedge * g.sin_column,
        bolster,
        column_compliance.force(y, p),
        fixture_resonance.force(y, p),
        acceleration(t, p),
    )


@inlined
def with_base(load, acceleration):
    """The loads under another acceleration of the table (m/s^2)."""
    return Loads(load.tangential, load.normal, load.vertical, load.lateral, load.frame, acceleration)


@inlined
def closed_contacts(p):
    """``Closed`` of a case."""
    s, g = p.suspension, p.geometry
    mobility, along = 1.0 / s.bolster_mass, s.wedge_mass * g.column_ratio
    push, push_mu = 2.0 * mobility * g.sin_wedge, 2.0 * mobility * g.cos_wedge
    return Closed(
        g.sin_included + along * push,
        g.cos_included + along * push_mu,
        -g.cos_included,
        g.sin_included,
        push,
        push_mu,
        mobility,
        along * mobility,
        s.wedge_mass * (g.cos_column - g.column_ratio),
        s.wedge_mass * g.sin_column,
    )


@inlined
def reactions(load, mu, p):
    """Forces, and the determinant of the equations for N_c and N_b, which is negative without friction.

        a11 N_c + a12 N_b = tangential        of the wedge along the column
        a21 N_c + a22 N_b = normal            of the wedge normal to the column

    after z'', Q'' and A are eliminated. Each stage of an integrator waits for this result: factors that do
    not depend on the loads are multiplied by each other first.
    """
    s, g, closed = p.suspension, p.geometry, closed_contacts(p)
    push = closed.push + mu.bolster * closed.push_mu
    a11, a12 = mu.column, closed.along + mu.bolster * closed.along_mu
    a21, a22 = 1.0, closed.into + mu.bolster * closed.into_mu
    tangential, normal, vertical = load.tangential, load.normal, load.vertical
    if load_dependent_friction.acts(p):
        tangential -= mu.column_tau + mu.bolster_tau * g.cos_included
        normal -= mu.bolster_tau * g.sin_included
        vertical += 2.0 * mu.bolster_tau * g.cos_wedge
    tangential -= closed.inertia * vertical

    # Acceleration of a column: Q'' = outward + outward_per_force N_c.
    outward, outward_per_force = 0.0, 0.0
    if column_compliance.acts(p):
        compliance = column_compliance.compliance(p)
        outward_per_force = compliance * (g.cos_column - mu.column * g.sin_column)
        outward = compliance * (load.lateral - mu.column_tau * g.sin_column)
        inertia_along = s.wedge_mass * g.cos_column * g.cos_included / g.sin_included
        inertia_into = s.wedge_mass * g.cos_column
        a11 += inertia_along * outward_per_force
        a21 += inertia_into * outward_per_force
        tangential -= inertia_along * outward
        normal -= inertia_into * outward

    # Acceleration of the side frame: A = base + base_per_column N_c + base_per_bolster N_b.
    base, base_per_column, base_per_bolster, mass = load.base, 0.0, 0.0, 1.0
    if fixture_resonance.acts(p):
        carried = (s.bolster_mass + 2.0 * s.wedge_mass * g.column_ratio * g.cos_column) / s.bolster_mass
        mass = s.side_frame_mass + 2.0 * s.wedge_mass * (1.0 - g.column_ratio * g.cos_column)
        aside = 2.0 * s.wedge_mass * g.lift_ratio
        base = (load.frame - carried * vertical - aside * outward) / mass
        base_per_bolster = -carried * s.bolster_mass * push / mass
        base_per_column = -aside * outward_per_force / mass
        a11 += closed.along_base * base_per_column
        a12 += closed.along_base * base_per_bolster
        a21 += closed.into_base * base_per_column
        a22 += closed.into_base * base_per_bolster
    tangential -= closed.along_base * base
    normal -= closed.into_base * base

    determinant = a11 * a22 - a12 * a21
    inverse = 1.0 / determinant
    bolster = (a11 * normal - a21 * tangential) * inverse
    column = (tangential * a22 - a12 * normal) * inverse
    frame = base
    if fixture_resonance.acts(p):
        frame += base_per_column * column + base_per_bolster * bolster
    z2 = vertical * closed.mobility - frame + push * bolster
    # A light side frame whose columns lean outward has a negative ``mass``: the determinant is divided by it.
    determinant *= mass
    return Forces(z2, outward + outward_per_force * column, frame - load.base, column, bolster), determinant


@inner
def _loaded_reactions(load, column_mu, bolster_mu, p):
    """``reactions`` with coefficients that depend on the load, by Newton's method.

    The coefficients carry the signs of their normal forces. NaN, and a determinant of 0, where it does not
    converge.
    """
    now, determinant = reactions(load, NO_FRICTION, p)
    exponent = load_dependent_friction.exponent(p)
    for _ in range(LOAD_ITERATIONS):
        column = load_dependent_friction.coefficient(column_mu, now.column, p)
        bolster = load_dependent_friction.coefficient(bolster_mu, now.bolster, p)
        tangent = Coefficients(
            (1.0 - exponent) * column,
            (1.0 - exponent) * bolster,
            exponent * column * now.column,
            exponent * bolster * now.bolster,
        )
        following, determinant = reactions(load, tangent, p)
        of_column, of_bolster = abs(following.column - now.column), abs(following.bolster - now.bolster)
        now = following
        if of_column <= LAST_CHANGE * abs(now.column) and of_bolster <= LAST_CHANGE * abs(now.bolster):
            return now, determinant
    if of_column + of_bolster <= LIFT_OFF_CHANGE * (abs(now.column) + abs(now.bolster)):
        return now, determinant
    return UNDETERMINED, 0.0


@inlined
def _reactions_for_signs(load, column_mu, bolster_mu, mode, p):
    """Forces, and the determinant, for the mode's signs of the normal forces."""
    column_mu, bolster_mu = mode.column_sign * column_mu, mode.bolster_sign * bolster_mu
    if load_dependent_friction.acts(p):
        return _loaded_reactions(load, column_mu, bolster_mu, p)
    return reactions(load, Coefficients(column_mu, bolster_mu, 0.0, 0.0), p)


@inlined
def forces(t, y, mode, p):
    """Forces in a mode, with its signs of the normal forces."""
    column_mu, bolster_mu = coefficients(t, y, mode, p)
    return _reactions_for_signs(loads(t, y, mode, p), column_mu, bolster_mu, mode, p)[0]


@inner
def solve_for_signs(t, y, mode, p):
    """The mode with the signs of its normal forces, these forces, and whether they are unique.

    Friction acts with |N|, so that each combination of signs is a linear problem of its own; one that returns
    the signs that it assumed is a solution. The wedge locks if there is none, or more than one; a solution
    whose determinant has another sign than without friction is never the only one.
    """
    column_mu, bolster_mu = coefficients(t, y, mode, p)
    load = loads(t, y, mode, p)
    zero = ROUNDING * (abs(load.tangential) + abs(load.normal) + abs(load.vertical))
    found, result, certain = mode, UNDETERMINED, 0
    possible = proper = False
    for column_sign in (1, -1):
        for bolster_sign in (1, -1):
            trial = with_signs(mode, column_sign, bolster_sign)
            now, determinant = _reactions_for_signs(load, column_mu, bolster_mu, trial, p)
            smallest = min(column_sign * now.column, bolster_sign * now.bolster)
            if smallest > zero:
                if p.geometry.always_well_posed:
                    return trial, now, True
                certain += 1
            if smallest >= -zero and (smallest > zero or not possible):
                found, result, possible = trial, now, True
                proper = determinant < 0.0
    return found, result, possible and proper and certain <= 1


@inner
def stuck_forces(t, y, mode, p):
    """Forces while set-valued friction holds the bolster: the side frame carries the whole suspension."""
    frame = 0.0
    if fixture_resonance.acts(p):
        s, load = p.suspension, loads(t, y, mode, p)
        frame = load.frame / (s.side_frame_mass + s.bolster_mass + 2.0 * s.wedge_mass) - load.base
    return Forces(0.0, 0.0, frame, nan, nan)


@inlined
def _with_force(load, force):
    """The loads with a further force on the bolster (N)."""
    return Loads(load.tangential, load.normal, load.vertical + force, load.lateral, load.frame, load.base)


@inner
def driving_force(t, acceleration, y, mode, p):
    """Force on the bolster (N) that gives it an acceleration; NaN where that would lift a face off.

    The acceleration is linear in the force unless friction depends on the load: then this iterates.
    """
    column_mu, bolster_mu = coefficients(t, y, mode, p)
    load, closed = loads(t, y, mode, p), with_signs(mode, 1, 1)
    force, unit = 0.0, p.suspension.bolster_mass
    for _ in range(LOAD_ITERATIONS):
        now = _reactions_for_signs(_with_force(load, force), column_mu, bolster_mu, closed, p)[0]
        beside = _reactions_for_signs(_with_force(load, force + unit), column_mu, bolster_mu, closed, p)[0]
        change = unit * (acceleration - now.acceleration) / (beside.acceleration - now.acceleration)
        if abs(change) <= LAST_CHANGE * abs(force):
            break
        force += change
    return force if min(now.column, now.bolster) >= 0.0 else nan
