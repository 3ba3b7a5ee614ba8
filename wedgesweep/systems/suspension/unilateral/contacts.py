"""Which contacts of a wedge carry load, and their reactions: a complementarity problem with Coulomb friction.

One problem serves accelerations and impulses. Given is how the wedge and the bolster would move without
reactions; sought are reactions that are compressive, obey Coulomb's law, and let no face penetrate:

    A = A0 - (T_c + S N_b + c T_b) / M_w          along the column        S, c = sin, cos(alpha + gamma)
    G = G0 + (N_c - c N_b + S T_b) / M_w          gap at the column
    Z = Z0 + 2 (sin(alpha) N_b + cos(alpha) T_b) / M_b      bolster
    B = sin(alpha) Z - S A - c G                  gap at the bolster face
    v_c = A,  v_b = c A - S G - cos(alpha) Z      slip
    G >= 0, N_c >= 0, G N_c = 0;  B >= 0, N_b >= 0, B N_b = 0;  -T in mu N Sgn(v) on either face

A, G, Z and B are accelerations and the reactions forces (N), or velocities and impulses (N s). Each face is
open, slips or sticks; every combination is a linear problem, and one that fulfils the inequalities is a
solution.
Formulation: Pfeiffer and Glocker, Multibody Dynamics with Unilateral Contacts (1996).
"""

from math import inf
from typing import NamedTuple

from wedgesweep.compiled import inlined, inner

# States of a face.
OPEN, FORWARD, BACKWARD, STICK = range(4)
STATES = 4
# Reactions below this share of the loads count as zero.
ROUNDING = 1e-11


class Motion(NamedTuple):
    """A, G and Z: of the wedge along the column, the gap at the column, the bolster (m/s^2 or m/s)."""

    along: float
    gap: float
    rise: float


class Reactions(NamedTuple):
    """Normal and friction reaction of both faces of one wedge: forces (N) or impulses (N s)."""

    column: float
    column_friction: float
    bolster: float
    bolster_friction: float


class Faces(NamedTuple):
    """Which faces touch, and their coefficients of friction.

    ``slipping``: whether they slip already, with signed coefficients; else whether they slip, and in which
    direction, is part of the problem, and the coefficients are not signed.
    """

    column: bool
    bolster: bool
    slipping: bool
    column_mu: float
    bolster_mu: float


class Solution(NamedTuple):
    """States of both faces, reactions, and the margin by which all inequalities are fulfilled (N or N s).

    A solution of the problem has a margin of 0 or more.
    """

    column: int
    bolster: int
    reactions: Reactions
    margin: float


NOTHING = Reactions(0.0, 0.0, 0.0, 0.0)


@inlined
def motion_under(free, now, p):
    """Motion under reactions, from the motion without them, ``free``."""
    s, g = p.suspension, p.geometry
    across, along = g.sin_included, g.cos_included
    lift = g.sin_wedge * now.bolster + g.cos_wedge * now.bolster_friction
    push = now.column_friction + across * now.bolster + along * now.bolster_friction
    part = now.column - along * now.bolster + across * now.bolster_friction
    return Motion(
        free.along - push / s.wedge_mass,
        free.gap + part / s.wedge_mass,
        free.rise + 2.0 * lift / s.bolster_mass,
    )


@inlined
def bolster_gap(motion, p):
    """B: acceleration or velocity of the gap at the bolster face."""
    g = p.geometry
    return g.sin_wedge * motion.rise - g.sin_included * motion.along - g.cos_included * motion.gap


@inlined
def bolster_slip(motion, p):
    """v_b: slip acceleration or velocity of the bolster face."""
    g = p.geometry
    return g.cos_included * motion.along - g.sin_included * motion.gap - g.cos_wedge * motion.rise


# Reactions in each state


@inlined
def column_reactions(free, sticks, mu, p):
    """Reactions if the column alone is closed; it slips with a signed coefficient."""
    mass = p.suspension.wedge_mass
    normal = -mass * free.gap
    return Reactions(normal, mass * free.along if sticks else mu * normal, 0.0, 0.0)


@inlined
def bolster_reactions(free, sticks, mu, p):
    """Reactions if the bolster face alone is closed; it slips with a signed coefficient."""
    s, g = p.suspension, p.geometry
    mobility = 2.0 / s.bolster_mass
    normal = 1.0 / s.wedge_mass + mobility * g.sin_wedge**2
    mixed = mobility * g.sin_wedge * g.cos_wedge
    closing = -bolster_gap(free, p)
    if not sticks:
        load = closing / (normal + mu * mixed)
        return Reactions(0.0, 0.0, load, mu * load)
    tangential = 1.0 / s.wedge_mass + mobility * g.cos_wedge**2
    slip, determinant = bolster_slip(free, p), normal * tangential - mixed * mixed
    load = (closing * tangential - mixed * slip) / determinant
    return Reactions(0.0, 0.0, load, (normal * slip - mixed * closing) / determinant)


@inlined
def both_reactions(free, column_mu, bolster_mu, p):
    """Reactions if both faces are closed and slip; the coefficients are signed."""
    s, g = p.suspension, p.geometry
    across = column_mu * g.sin_included - g.cos_included
    into = g.cos_included - bolster_mu * g.sin_included
    lift = g.sin_wedge * (g.sin_wedge + bolster_mu * g.cos_wedge)
    determinant = 1.0 + 2.0 * s.wedge_mass / s.bolster_mass * lift + across * into
    bolster = s.wedge_mass * (free.gap * across - bolster_gap(free, p)) / determinant
    column = into * bolster - s.wedge_mass * free.gap
    return Reactions(column, column_mu * column, bolster, bolster_mu * bolster)


@inner
def sticking_reactions(free, column_mu, bolster_mu, p):
    """Reactions if both faces stick, and how far (N or N s) friction is from its limits.

    The four reactions fulfil three equations: they lie on a line, of which Coulomb's law allows an interval.
    Returns the reactions in its middle, and its length; this is negative if there is no such interval.
    """
    lift = -0.5 * p.suspension.bolster_mass * free.rise
    start = _on_line(free, lift, 0.0, p)
    there = _on_line(free, lift, 1.0, p)
    low, high = -inf, inf
    for number in range(6):
        value = _limit(number, start, column_mu, bolster_mu)
        slope = _limit(number, there, column_mu, bolster_mu) - value
        if slope > 0.0:
            low = max(low, -value / slope)
        elif slope < 0.0:
            high = min(high, -value / slope)
        elif value < 0.0:
            return start, -inf
    return _on_line(free, lift, 0.5 * (low + high), p), high - low


@inlined
def _on_line(free, lift, place, p):
    """Reactions that hold wedge and bolster, at a place on their line; ``lift`` (N): on half the bolster."""
    s, g = p.suspension, p.geometry
    bolster = lift * g.sin_wedge + place * g.cos_wedge
    friction = lift * g.cos_wedge - place * g.sin_wedge
    return Reactions(
        g.cos_included * bolster - g.sin_included * friction - s.wedge_mass * free.gap,
        s.wedge_mass * free.along - g.sin_included * bolster - g.cos_included * friction,
        bolster,
        friction,
    )


@inlined
def _limit(number, now, column_mu, bolster_mu):
    """One of six numbers that Coulomb's law wants positive: mu N - T, mu N + T and N of both faces."""
    normal, friction, mu = now.column, now.column_friction, column_mu
    if number >= 3:
        normal, friction, mu = now.bolster, now.bolster_friction, bolster_mu
    if number % 3 == 2:
        return normal
    return mu * normal + (friction if number % 3 else -friction)


# Enumeration


@inlined
def _possible(column, bolster, faces, p):
    """Whether the states of both faces can occur together: two closed faces slip or stick only together."""
    if (column != OPEN and not faces.column) or (bolster != OPEN and not faces.bolster):
        return False
    if faces.slipping:
        return column <= FORWARD and bolster <= FORWARD
    if column == OPEN or bolster == OPEN or (column == STICK and bolster == STICK):
        return True
    if column == STICK or bolster == STICK:
        return False
    return (column == bolster) == (p.geometry.bolster_ratio > 0.0)


@inlined
def _direction(state):
    return 1.0 if state == FORWARD else -1.0


@inlined
def _face_margin(state, touches, slipping, mu, reaction, after):
    """Least of the numbers that must be positive on a face in a state.

    ``reaction``: its normal and friction reaction; ``after``: its gap and slip under the reactions times a
    mass.
    """
    (normal, friction), (gap, slip) = reaction, after
    if state == OPEN:
        return gap if touches else inf
    if state == STICK:
        return min(normal, mu * normal - abs(friction))
    return normal if slipping else min(normal, _direction(state) * slip)


@inner
def _solution(column, bolster, free, faces, p):
    """Reactions for given states of both faces, with their margin: -inf if the states cannot occur."""
    if not _possible(column, bolster, faces, p):
        return Solution(column, bolster, NOTHING, -inf)
    column_mu, bolster_mu = faces.column_mu, faces.bolster_mu
    if column == STICK and bolster == STICK:
        now, width = sticking_reactions(free, column_mu, bolster_mu, p)
        return Solution(column, bolster, now, width)
    if not faces.slipping:
        column_mu, bolster_mu = _direction(column) * column_mu, _direction(bolster) * bolster_mu
    now = NOTHING
    if column != OPEN and bolster != OPEN:
        now = both_reactions(free, column_mu, bolster_mu, p)
    elif column != OPEN:
        now = column_reactions(free, column == STICK, column_mu, p)
    elif bolster != OPEN:
        now = bolster_reactions(free, bolster == STICK, bolster_mu, p)
    after, mass = motion_under(free, now, p), p.suspension.wedge_mass
    of_column = _face_margin(
        column,
        faces.column,
        faces.slipping,
        faces.column_mu,
        (now.column, now.column_friction),
        (mass * after.gap, mass * after.along),
    )
    of_bolster = _face_margin(
        bolster,
        faces.bolster,
        faces.slipping,
        faces.bolster_mu,
        (now.bolster, now.bolster_friction),
        (mass * bolster_gap(after, p), mass * bolster_slip(after, p)),
    )
    return Solution(column, bolster, now, min(of_column, of_bolster))


@inner
def solve(free, faces, p):
    """The solution with the largest margin, and how many have a margin beyond rounding.

    The problem is ill-posed if there are several, or if the largest margin is negative. Faces that wedge each
    other could hold loads under which they can also slip; they stick only where no motion is possible, as in
    the limit of regularised friction, and as with bilateral joints.
    """
    zero = rounding(free, p)
    best, certain = solve_unless_stuck(free, faces, p)
    if certain == 0 and faces.column and faces.bolster and not faces.slipping:
        sticks = _solution(STICK, STICK, free, faces, p)
        if best.margin < -zero and sticks.margin > zero:
            return sticks, 1
        if sticks.margin > best.margin:
            return sticks, 0
    return best, certain


@inner
def solve_unless_stuck(free, faces, p):
    """As ``solve``, but for the solution in which both faces stick."""
    zero = rounding(free, p)
    best, certain = Solution(OPEN, OPEN, NOTHING, -inf), 0
    for number in range(STATES * STATES - 1):
        found = _solution(number // STATES, number % STATES, free, faces, p)
        if found.margin > zero:
            certain += 1
        if found.margin > best.margin:
            best = found
    return best, certain


@inlined
def rounding(free, p):
    """Reactions (N or N s) that may be rounding errors."""
    s = p.suspension
    wedge = s.wedge_mass * (abs(free.along) + abs(free.gap))
    return ROUNDING * (wedge + s.bolster_mass * abs(free.rise))
