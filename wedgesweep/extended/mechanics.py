"""Newton's equations of the extended system: accelerations and normal forces on a smooth piece.

With w the wedge's displacement against the side frame, w = A_t t_c + Q cos g n_c, both contacts closed:

    A_t = r z + Q cos g cot(a+g)         w_z = r cos g z + Q cos g cos a/sin(a+g)
    v_c = r z' + Q' cos a/sin(a+g)       v_b = q z' + Q' cos g/sin(a+g)

Unknown are z'', Q'', the side frame's own acceleration A and both normal forces; the accelerations are
linear in the forces, which leaves two equations. Friction T = mu |N| is written as T = tau + m N: m alone
where the coefficient does not depend on the load, a tangent where it does.
"""

from math import nan
from typing import NamedTuple

from wedgesweep import excitation
from wedgesweep.compiled import compiled, inlined
from wedgesweep.contact import ROUNDING
from wedgesweep.effects import cubic_stiffness, end_stop, guide_friction, viscous_damping
from wedgesweep.extended.faces import bristle_rate, coefficients
from wedgesweep.extended.mode import (
    COLUMN_VELOCITY,
    COLUMN_WAY,
    FRAME_VELOCITY,
    FRAME_WAY,
    VELOCITY,
    X,
    with_signs,
)

# Newton's method for coefficients that depend on the load. As its error is squared at each step, a change of
# both normal forces by this share is the last one that shows. Next to lift-off a force is rounding, and never
# settles: then changes that end below this share of both will do.
LOAD_ITERATIONS, LAST_CHANGE, NEXT_TO_NOTHING, LEAST_LOAD = 40, 1e-7, 1e-11, 1e-30


class Forces(NamedTuple):
    """What follows from a state on one mode: accelerations (m/s^2) and normal forces (N).

    z'' of the bolster, Q'' of a column, d'' of the side frame against its table, and the normal forces
    on column and bolster face, compression positive.
    """

    acceleration: float
    column_acceleration: float
    frame_acceleration: float
    column: float
    bolster: float


class Loads(NamedTuple):
    """Loads (N) without contact forces, and without the inertia of the side frame's acceleration.

    On a wedge along and into the column, on the bolster, on a column outward, on the side frame from
    its table; ``base`` is the table's acceleration (m/s^2).
    """

    along: float
    into: float
    vertical: float
    outward: float
    frame: float
    base: float


@compiled
def loads(t, y, mode, p):
    """Loads at a state; see ``Loads``."""
    z, way = p.rest + y[X], p.column_rest + y[COLUMN_WAY]
    lifted = p.column_ratio * p.cos_column * z + p.lift_ratio * way
    wedge = p.wedge_preload - p.wedge_spring * lifted - p.wedge_mass * p.gravity
    bolster = -p.bolster_spring * z - p.bolster_mass * p.gravity
    bolster += guide_friction.force(y[VELOCITY], mode.guide, p) + viscous_damping.force(y[VELOCITY], p)
    bolster += cubic_stiffness.force(z, p) + end_stop.force(y[X], mode.stop, p)
    outward = -p.column_compliance_stiffness * way - p.column_damping * y[COLUMN_VELOCITY]
    frame = -p.fixture_stiffness * y[FRAME_WAY] - p.fixture_damping * y[FRAME_VELOCITY]
    base = excitation.table_acceleration(t, p)
    return Loads(wedge * p.cos_column, wedge * p.sin_column, bolster, outward, frame, base)


@compiled
def reactions(load, column_mu, bolster_mu, column_tau, bolster_tau, p):
    """Forces for T_c = column_tau + column_mu N_c and T_b alike, and the determinant of their equations.

    The determinant is negative without friction.
    """
    compliance = 1.0 / p.column_compliance_mass if p.column_compliance_stiffness > 0.0 else 0.0
    outward_per = p.cos_column - column_mu * p.sin_column
    outward = (load.outward - column_tau * p.sin_column) * compliance
    lift = p.sin_wedge + bolster_mu * p.cos_wedge
    vertical = load.vertical + 2.0 * bolster_tau * p.cos_wedge

    base, base_column, base_bolster = load.base, 0.0, 0.0
    if p.fixture_stiffness > 0.0:
        moved = p.bolster_mass + 2.0 * p.wedge_mass * p.column_ratio * p.cos_column
        mass = p.side_frame_mass + 2.0 * p.wedge_mass * (1.0 - p.column_ratio * p.cos_column)
        aside = 2.0 * p.wedge_mass * p.lift_ratio
        base = (load.frame - moved / p.bolster_mass * vertical - aside * outward) / mass
        base_bolster = -2.0 * moved / p.bolster_mass * lift / mass
        base_column = -aside * compliance * outward_per / mass

    along_way = p.wedge_mass * p.cos_column * p.cos_included / p.sin_included
    into_way = p.wedge_mass * p.cos_column
    rise = p.wedge_mass * p.column_ratio / p.bolster_mass
    along_base = p.wedge_mass * (p.cos_column - p.column_ratio)
    into_base = p.wedge_mass * p.sin_column

    a11 = column_mu + along_way * compliance * outward_per + along_base * base_column
    a12 = p.sin_included + bolster_mu * p.cos_included + 2.0 * lift * rise + along_base * base_bolster
    a21 = 1.0 + into_way * compliance * outward_per + into_base * base_column
    a22 = bolster_mu * p.sin_included - p.cos_included + into_base * base_bolster
    along = load.along - column_tau - bolster_tau * p.cos_included
    along -= rise * vertical + along_way * outward + along_base * base
    into = load.into - bolster_tau * p.sin_included - into_way * outward - into_base * base

    determinant = a11 * a22 - a12 * a21
    bolster = (a11 * into - a21 * along) / determinant
    column = (along * a22 - a12 * into) / determinant
    base += base_column * column + base_bolster * bolster
    acceleration = (vertical + 2.0 * bolster * lift) / p.bolster_mass - base
    way = outward + compliance * outward_per * column
    return Forces(acceleration, way, base - load.base, column, bolster), determinant


@inlined
def _secant(mu, normal, p):
    """T/N of a face at a normal force of either sign, which is kept off zero."""
    load = max(abs(normal), LEAST_LOAD)
    return mu * (load / p.load_dependent_friction_reference) ** (-p.load_dependent_friction_exponent)


@compiled
def loaded_reactions(load, column_mu, bolster_mu, p):
    """``reactions`` with coefficients that depend on the load, by Newton's method.

    The coefficients carry the signs of their normal forces. NaN, and a determinant of 0, where it does not
    converge.
    """
    now, determinant = reactions(load, 0.0, 0.0, 0.0, 0.0, p)
    exponent = p.load_dependent_friction_exponent
    for _ in range(LOAD_ITERATIONS):
        column, bolster = _secant(column_mu, now.column, p), _secant(bolster_mu, now.bolster, p)
        following, determinant = reactions(
            load,
            (1.0 - exponent) * column,
            (1.0 - exponent) * bolster,
            exponent * column * now.column,
            exponent * bolster * now.bolster,
            p,
        )
        of_column, of_bolster = abs(following.column - now.column), abs(following.bolster - now.bolster)
        now = following
        if of_column <= LAST_CHANGE * abs(now.column) and of_bolster <= LAST_CHANGE * abs(now.bolster):
            return now, determinant
    if of_column + of_bolster <= NEXT_TO_NOTHING * (abs(now.column) + abs(now.bolster)):
        return now, determinant
    return Forces(nan, nan, nan, nan, nan), 0.0


@inlined
def signed(load, column_mu, bolster_mu, column_sign, bolster_sign, p):
    """Forces, and the determinant, for given signs of the normal forces."""
    column_mu, bolster_mu = column_sign * column_mu, bolster_sign * bolster_mu
    if p.load_dependent_friction_exponent != 0.0:
        return loaded_reactions(load, column_mu, bolster_mu, p)
    return reactions(load, column_mu, bolster_mu, 0.0, 0.0, p)


@compiled
def forces(t, y, mode, p):
    """Forces on the given mode."""
    column_mu, bolster_mu = coefficients(t, y, mode, p)
    load = loads(t, y, mode, p)
    return signed(load, column_mu, bolster_mu, mode.column_sign, mode.bolster_sign, p)[0]


@compiled
def closed(t, y, mode, p):
    """The mode with the signs of its normal forces, these forces, and whether they are unique.

    As ``contact.closed``; a solution whose determinant has another sign than without friction is never
    the only one.
    """
    column_mu, bolster_mu = coefficients(t, y, mode, p)
    load = loads(t, y, mode, p)
    zero = ROUNDING * (abs(load.along) + abs(load.into) + abs(load.vertical))
    found, result, certain = mode, Forces(nan, nan, nan, nan, nan), 0
    possible = proper = False
    for column_sign in (1, -1):
        for bolster_sign in (1, -1):
            now, determinant = signed(load, column_mu, bolster_mu, column_sign, bolster_sign, p)
            smallest = min(column_sign * now.column, bolster_sign * now.bolster)
            if smallest > zero:
                if p.never_locks:
                    return with_signs(mode, column_sign, bolster_sign), now, True
                certain += 1
            if smallest >= -zero and (smallest > zero or not possible):
                found, result, possible = with_signs(mode, column_sign, bolster_sign), now, True
                proper = determinant < 0.0
    return found, result, possible and proper and certain <= 1


@compiled
def riding(t, y, mode, p):
    """Forces while set-valued friction holds the bolster: the side frame carries the whole suspension."""
    frame = 0.0
    if p.fixture_stiffness > 0.0:
        load = loads(t, y, mode, p)
        mass = p.side_frame_mass + p.bolster_mass + 2.0 * p.wedge_mass
        frame = load.frame / mass - load.base
    return Forces(0.0, 0.0, frame, nan, nan)


@inlined
def write_rate(y, mode, now, p, out):
    """Write dy/dt, shape (SIZE,), from the forces ``now``."""
    out[0], out[1] = y[VELOCITY], now.acceleration
    out[2] = bristle_rate(y, mode, p)
    out[3], out[4] = y[COLUMN_VELOCITY], now.column_acceleration
    out[5], out[6] = y[FRAME_VELOCITY], now.frame_acceleration
    out[7] = 1.0 if mode.clock and p.ageing_rate > 0.0 else 0.0
