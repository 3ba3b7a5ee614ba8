"""Which contacts of a wedge carry load, and their reactions: a complementarity problem with Coulomb friction.

One problem serves accelerations and impulses. Given is the motion m = (A, G, Z) of wedge and bolster against
the side frame without reactions, m0: along the column, gap at the column, and of the bolster. Sought are
reactions that are compressive, obey Coulomb's law, and let no face penetrate:

    m = m0 + W f      f_A = -T_c - S N_b - c T_b            S, c = sin, cos(alpha + gamma)
                      f_G = N_c - c N_b + S T_b
                      f_Z = sin(alpha) N_b + cos(alpha) T_b + H/2
    B = sin(alpha) Z - S A - c G                            gap at the bolster face
    v_c = A,  v_b = c A - S G - cos(alpha) Z                slip
    G >= 0, N_c >= 0, G N_c = 0;  B >= 0, N_b >= 0, B N_b = 0;  -T in mu N Sgn(v) on either face

W = diag(1/M_w, 1/M_w, 2/M_b), and (2/M_sf) e e' more if the side frame rides on a compliant table, with
e = (cos(gamma), -sin(gamma), 1). H is the friction of a guide against which the bolster rests, under a
set-valued law: it holds the bolster, or slips with its whole force. Elsewhere the guide is part of m0.
A, G, Z and B are accelerations and the reactions forces (N), or velocities and impulses (N s). Each face is
open, slips or sticks; every combination is a linear problem, and one that fulfils the inequalities is a
solution.
Formulation: Pfeiffer and Glocker, Multibody Dynamics with Unilateral Contacts (1996).
"""

from math import inf
from typing import NamedTuple

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import fixture_resonance
from wedgesweep.systems.shared import ROUNDING
from wedgesweep.systems.suspension.equilibrium import determinant
from wedgesweep.systems.suspension.newton import Coefficients, Loads, reactions

# States of a face.
OPEN, FORWARD, BACKWARD, STICK = range(4)
STATES = 4
# A determinant D below this share of that without friction counts as zero. Accelerations grow as 1/D, and the
# time to a pole falls as D^2: it is shorter than the shortest step of an integrator then.
SINGULAR = 1e-6
# Steps of the search for the force of the guide under which both faces stick; each leaves two thirds.
SEARCH_STEPS = 60


class Motion(NamedTuple):
    """A, G and Z: of the wedge along the column, the gap at the column, the bolster (m/s^2 or m/s)."""

    along: float
    gap: float
    rise: float


class Mobility(NamedTuple):
    """The symmetric matrix W (1/kg), by the initials of along, gap and rise."""

    aa: float
    ag: float
    ar: float
    gg: float
    gr: float
    rr: float


class Reactions(NamedTuple):
    """Normal and friction reaction of both faces of one wedge: forces (N) or impulses (N s)."""

    column: float
    column_friction: float
    bolster: float
    bolster_friction: float


class Faces(NamedTuple):
    """Which faces touch, and their coefficients of friction.

    ``slipping``: whether they slip already, with signed coefficients; else whether they slip, and in which
    direction, is part of the problem, and the coefficients are not signed. ``guide_rests``: whether the
    bolster rests against a guide that rubs, so that its motion there is part of the problem as well.
    """

    column: bool
    bolster: bool
    slipping: bool
    column_mu: float
    bolster_mu: float
    guide_rests: bool


class Solution(NamedTuple):
    """States of both faces and of the guide, reactions, and the least margin of all inequalities (N or N s).

    A solution of the problem has a margin of 0 or more. ``guide``: direction of slip, 0 if it holds the
    bolster, or if it is no part of the problem.
    """

    column: int
    bolster: int
    guide: int
    reactions: Reactions
    margin: float


class Problem(NamedTuple):
    """Motion without the reactions of the faces, and what these do, for one state of the guide."""

    free: Motion
    mobility: Mobility
    guide: int


NOTHING = Reactions(0.0, 0.0, 0.0, 0.0)


@inlined
def mobility(p):
    """W of wedge, bolster and side frame."""
    s, g = p.suspension, p.geometry
    wedge, frame = 1.0 / s.wedge_mass, 0.0
    if fixture_resonance.acts(p):
        frame = 2.0 / s.side_frame_mass
    return Mobility(
        wedge + frame * g.cos_column**2,
        -frame * g.cos_column * g.sin_column,
        frame * g.cos_column,
        wedge + frame * g.sin_column**2,
        -frame * g.sin_column,
        2.0 / s.bolster_mass + frame,
    )


@inlined
def _times(w, along, gap, rise):
    """W f."""
    return Motion(
        w.aa * along + w.ag * gap + w.ar * rise,
        w.ag * along + w.gg * gap + w.gr * rise,
        w.ar * along + w.gr * gap + w.rr * rise,
    )


@inlined
def motion_under(free, w, now, p):
    """Motion under reactions of the faces, from the motion without them."""
    g = p.geometry
    across, along = g.sin_included, g.cos_included
    change = _times(
        w,
        -(now.column_friction + across * now.bolster + along * now.bolster_friction),
        now.column - along * now.bolster + across * now.bolster_friction,
        g.sin_wedge * now.bolster + g.cos_wedge * now.bolster_friction,
    )
    return Motion(free.along + change.along, free.gap + change.gap, free.rise + change.rise)


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


# The guide


@inlined
def _pushed(free, w, force):
    """Motion under a force (N) on half the bolster."""
    return Motion(free.along + w.ar * force, free.gap + w.gr * force, free.rise + w.rr * force)


@inlined
def with_guide(free, guide, p):
    """The problem with a guide that slips in a direction, or holds the bolster (0)."""
    w, force = mobility(p), 0.5 * p.guide_friction.force
    if guide != 0:
        return Problem(_pushed(free, w, -guide * force), w, guide)
    held = _pushed(free, w, -free.rise / w.rr)
    along, gap = w.ar / w.rr, w.gr / w.rr
    rest = Mobility(w.aa - w.ar * along, w.ag - w.ar * gap, 0.0, w.gg - w.gr * gap, 0.0, 0.0)
    return Problem(Motion(held.along, held.gap, 0.0), rest, 0)


@inlined
def guide_reaction(free, now, p):
    """Force (N) with which the guide holds the bolster, under reactions of the faces.

    ``free``: motion without either.
    """
    w = mobility(p)
    return -2.0 * motion_under(free, w, now, p).rise / w.rr


@inlined
def _guide_margin(problem, free, now, after, p):
    """Margin (N) of the guide: to its limit while it holds, else that of slip in its direction."""
    if problem.guide != 0:
        return 0.5 * p.suspension.bolster_mass * problem.guide * after.rise
    return 0.5 * (p.guide_friction.force - abs(guide_reaction(free, now, p)))


# Reactions in each state


@inlined
def column_reactions(free, w, sticks, mu):
    """Reactions if the column alone is closed; it slips with a signed coefficient."""
    if not sticks:
        normal = -free.gap / (w.gg - mu * w.ag)
        return Reactions(normal, mu * normal, 0.0, 0.0)
    determinant = w.aa * w.gg - w.ag * w.ag
    normal = (w.ag * free.along - w.aa * free.gap) / determinant
    return Reactions(normal, (w.gg * free.along - w.ag * free.gap) / determinant, 0.0, 0.0)


@inlined
def bolster_reactions(free, w, sticks, mu, p):
    """Reactions if the bolster face alone is closed; it slips with a signed coefficient."""
    g = p.geometry
    by_normal = _times(w, -g.sin_included, -g.cos_included, g.sin_wedge)
    by_friction = _times(w, -g.cos_included, g.sin_included, g.cos_wedge)
    normal, mixed = bolster_gap(by_normal, p), bolster_gap(by_friction, p)
    closing = -bolster_gap(free, p)
    if not sticks:
        load = closing / (normal + mu * mixed)
        return Reactions(0.0, 0.0, load, mu * load)
    tangential, slip = -bolster_slip(by_friction, p), bolster_slip(free, p)
    determinant = normal * tangential - mixed * mixed
    load = (closing * tangential - mixed * slip) / determinant
    return Reactions(0.0, 0.0, load, (normal * slip - mixed * closing) / determinant)


@inlined
def regularity(column_mu, bolster_mu, p):
    """Determinant of both faces that slip, with signed coefficients, over that without friction."""
    return determinant(column_mu, bolster_mu, p) / determinant(0.0, 0.0, p)


@inlined
def _singular(faces, p):
    """Whether the reactions of two faces that slip have a pole: they change their sign, and are not zero."""
    if not (faces.slipping and faces.column and faces.bolster):
        return False
    return abs(regularity(faces.column_mu, faces.bolster_mu, p)) < SINGULAR


@inlined
def both_reactions(free, column_mu, bolster_mu, p):
    """Reactions if both faces are closed and slip, as bilateral joints; the coefficients are signed."""
    hold = _holding(free, p)
    load = Loads(-hold.along, hold.gap, -2.0 * hold.rise, 0.0, 0.0, 0.0)
    now = reactions(load, Coefficients(column_mu, bolster_mu, 0.0, 0.0), p)[0]
    return Reactions(now.column, column_mu * now.column, now.bolster, bolster_mu * now.bolster)


@inlined
def _holding(free, p):
    """Forces f that hold wedge and bolster: W f = -m0."""
    s, g = p.suspension, p.geometry
    half = 0.5 * s.bolster_mass
    along, gap, rise = s.wedge_mass * free.along, s.wedge_mass * free.gap, half * free.rise
    if fixture_resonance.acts(p):
        # By Sherman and Morrison; the side frame takes part in the motion.
        load = g.cos_column * along - g.sin_column * gap + rise
        frame = load / (0.5 * s.side_frame_mass + s.wedge_mass + half)
        along -= frame * s.wedge_mass * g.cos_column
        gap += frame * s.wedge_mass * g.sin_column
        rise -= frame * half
    return Motion(-along, -gap, -rise)


@inner
def sticking_reactions(free, column_mu, bolster_mu, guide_rests, p):
    """Reactions if both faces stick, and how far (N or N s) friction is from its limits.

    The four reactions fulfil three equations: they lie on a line, of which Coulomb's law allows an interval.
    Returns the reactions in its middle, and its length; this is negative if there is no such interval. A
    guide holds what makes the interval longest: its length is a concave function of that force.
    """
    hold = _holding(free, p)
    if not guide_rests:
        return _sticking(hold, column_mu, bolster_mu, p)
    force = 0.5 * p.guide_friction.force
    low, high = -force, force
    for _ in range(SEARCH_STEPS):
        third = (high - low) / 3.0
        lower = _sticking(_with_lift(hold, low + third), column_mu, bolster_mu, p)[1]
        upper = _sticking(_with_lift(hold, high - third), column_mu, bolster_mu, p)[1]
        if lower < upper:
            low += third
        else:
            high -= third
    return _sticking(_with_lift(hold, 0.5 * (low + high)), column_mu, bolster_mu, p)


@inlined
def _with_lift(hold, lift):
    """The same with another force (N) on half the bolster."""
    return Motion(hold.along, hold.gap, hold.rise + lift)


@inner
def _sticking(hold, column_mu, bolster_mu, p):
    """Reactions with the resultant ``hold``, and the length of their interval."""
    start, there = _on_line(hold, 0.0, p), _on_line(hold, 1.0, p)
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
    return _on_line(hold, 0.5 * (low + high), p), high - low


@inlined
def _on_line(hold, place, p):
    """Reactions with the resultant ``hold``, at a place on their line."""
    g = p.geometry
    bolster = hold.rise * g.sin_wedge + place * g.cos_wedge
    friction = hold.rise * g.cos_wedge - place * g.sin_wedge
    return Reactions(
        hold.gap + g.cos_included * bolster - g.sin_included * friction,
        -hold.along - g.sin_included * bolster - g.cos_included * friction,
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
def _possible(column, bolster, guide_holds, faces, p):
    """Whether these states can occur together, if not both faces stick.

    Two closed faces slip only together, and with the bolster.
    """
    if (column != OPEN and not faces.column) or (bolster != OPEN and not faces.bolster):
        return False
    both = column != OPEN and bolster != OPEN
    if both and guide_holds:
        return False
    if faces.slipping:
        return column <= FORWARD and bolster <= FORWARD
    if not both:
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
def _solution(column, bolster, problem, free, faces, p):
    """Reactions for given states of faces and guide, with their margin: -inf if the states cannot occur.

    Not both faces stick. ``free``: motion without the guide, if it may hold the bolster.
    """
    guide, w = problem.guide, problem.mobility
    if not _possible(column, bolster, faces.guide_rests and guide == 0, faces, p):
        return Solution(column, bolster, guide, NOTHING, -inf)
    column_mu, bolster_mu = faces.column_mu, faces.bolster_mu
    if not faces.slipping:
        column_mu, bolster_mu = _direction(column) * column_mu, _direction(bolster) * bolster_mu
    now = NOTHING
    if column != OPEN and bolster != OPEN:
        now = both_reactions(problem.free, column_mu, bolster_mu, p)
    elif column != OPEN:
        now = column_reactions(problem.free, w, column == STICK, column_mu)
    elif bolster != OPEN:
        now = bolster_reactions(problem.free, w, bolster == STICK, bolster_mu, p)
    after, mass = motion_under(problem.free, w, now, p), p.suspension.wedge_mass
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
    margin = min(of_column, of_bolster)
    if faces.guide_rests:
        margin = min(margin, _guide_margin(problem, free, now, after, p))
    return Solution(column, bolster, guide, now, margin)


@inner
def solve(free, faces, p):
    """The solution with the largest margin, and how many have a margin beyond rounding.

    The problem is ill-posed if there are several, or if the largest margin is negative. Faces that wedge each
    other could hold loads under which they can also slip; they stick only where no motion is possible, as in
    the limit of regularised friction, and as with bilateral joints.
    """
    zero = rounding(free, p)
    best, certain = solve_unless_stuck(free, faces, p)
    if _singular(faces, p):
        return best, 2
    if certain == 0 and faces.column and faces.bolster and not faces.slipping:
        now, width = sticking_reactions(free, faces.column_mu, faces.bolster_mu, faces.guide_rests, p)
        sticks = Solution(STICK, STICK, 0, now, width)
        if best.margin < -zero and sticks.margin > zero:
            return sticks, 1
        if sticks.margin > best.margin:
            return sticks, 0
    return best, certain


@inner
def solve_unless_stuck(free, faces, p):
    """As ``solve``, but for the solution in which both faces stick."""
    if not faces.guide_rests:
        return _best(Problem(free, mobility(p), 0), free, faces, p)
    best, certain = _best(with_guide(free, 0, p), free, faces, p)
    for direction in (-1, 1):
        found, more = _best(with_guide(free, direction, p), free, faces, p)
        certain += more
        if found.margin > best.margin:
            best = found
    return best, certain


@inner
def _best(problem, free, faces, p):
    """The best solution for one state of the guide, and how many are certain."""
    zero = rounding(free, p)
    best, certain = Solution(OPEN, OPEN, problem.guide, NOTHING, -inf), 0
    for number in range(STATES * STATES - 1):
        found = _solution(number // STATES, number % STATES, problem, free, faces, p)
        if found.margin > zero:
            certain += 1
        if found.margin > best.margin:
            best = found
    return best, certain


@inner
def motion_of(solution, free, faces, p):
    """Motion in a solution."""
    if not faces.guide_rests:
        return motion_under(free, mobility(p), solution.reactions, p)
    problem = with_guide(free, solution.guide, p)
    return motion_under(problem.free, problem.mobility, solution.reactions, p)


@inlined
def weight(p):
    """Weight (N) of bolster and wedge, which the forces of the springs balance at rest."""
    return (p.suspension.bolster_mass + p.suspension.wedge_mass) * p.suspension.gravity


@inlined
def rounding(free, p):
    """Reactions (N or N s) that may be rounding errors."""
    s = p.suspension
    wedge = s.wedge_mass * (abs(free.along) + abs(free.gap))
    return ROUNDING * (wedge + s.bolster_mass * abs(free.rise))
