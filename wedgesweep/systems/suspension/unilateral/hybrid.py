"""The suspension with unilateral joints as a hybrid system; see hybrid/interface.py.

While both contacts are closed its equations and events are those of bilateral joints; where they surely carry
load (closed.py) so are its methods and transitions. Records of this system have a part ``lift_off`` beside
those of the suspension.
"""

from math import inf, nan, sqrt
from typing import NamedTuple

from wedgesweep import excitation, friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import guide_friction, hooks, states, travel
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.interface import implement
from wedgesweep.hybrid.vectors import replaced, with_first
from wedgesweep.systems.suspension import energy, events, filippov, transitions
from wedgesweep.systems.suspension import hybrid as bilateral
from wedgesweep.systems.suspension.events import BOLSTER_NORMAL, COLUMN_NORMAL, EVENTS, TRAVEL
from wedgesweep.systems.suspension.modes import (
    BOLSTER,
    COLUMN,
    GUIDE,
    SEGMENT,
    VELOCITY,
    X,
    held,
    with_branch,
    with_signs,
)
from wedgesweep.systems.suspension.newton import Accelerations
from wedgesweep.systems.suspension.unilateral import contacts, impact
from wedgesweep.systems.suspension.unilateral.closed import stays_closed
from wedgesweep.systems.suspension.unilateral.contacts import bolster_gap, bolster_slip
from wedgesweep.systems.suspension.unilateral.modes import (
    BOLSTER_CLOSES,
    COLUMN_CLOSES,
    closed,
    is_open,
    resolve,
    rests_in_guide,
    signed_coefficient,
    stuck,
    touching,
    without_jump,
)
from wedgesweep.systems.suspension.unilateral.motion import (
    BOLSTER_GAP,
    BOLSTER_RATE,
    COLUMN_GAP,
    COLUMN_RATE,
    UNILATERAL,
    frame_acceleration,
    free_accelerations,
    kinetic_energy,
    momentum_against_table,
    velocities,
    with_gaps,
    without_gaps,
)

implement(interface.holds, UNILATERAL)(stuck)


@implement(interface.only_first_move, UNILATERAL)
@inlined
def only_first_move(y, mode, p):
    """While both contacts surely carry load."""
    return stays_closed(without_gaps(y), mode, p)


@implement(interface.first_states, UNILATERAL)
@inlined
def first_states(y, p):
    """Those of bilateral joints."""
    return without_gaps(y)


@implement(interface.opened, UNILATERAL)
@inlined
def opened(mode, p):
    """Whether the column contact and the bolster contact are open."""
    return mode.column_sign == 0, mode.bolster_sign == 0


@implement(interface.free, UNILATERAL)
@inlined
def free(y, p):
    """A closed contact keeps its gap, and a bolster that friction holds its velocity."""
    column, bolster = is_open(y)
    pinned = p.friction.set_valued != 0 and y[VELOCITY] == 0.0
    pinned = pinned and (guide_friction.acts(p) or not (column or bolster))
    moves = replaced(states.active(p), VELOCITY, not pinned)
    return with_gaps(moves, (column, column, bolster, bolster))


# Motion


class UnilateralForces(NamedTuple):
    """Accelerations (m/s^2) of both gaps, and reactions (N) of both faces and the guide.

    Events of bilateral joints read the fields that have the names of ``newton.Forces``. Friction is NaN while
    both contacts are closed: no event needs it. The ``guide`` has a reaction while it holds the bolster.
    """

    gap_accelerations: tuple
    column: float
    column_friction: float
    bolster: float
    bolster_friction: float
    guide: float


@inlined
def _motion_and_reactions(t, y, mode, p):
    """Accelerations (m/s^2), reactions of the faces and of a guide that holds the bolster (N).

    For modes in which a contact is open.
    """
    free, motion = free_accelerations(t, y, mode.segment, mode.guide, p), velocities(y, p)
    unheld, w = free, contacts.mobility(p)
    if rests_in_guide(mode, p):
        held = contacts.with_guide(free, 0, p)
        free, w = held.free, held.mobility
    now = contacts.NOTHING
    if mode.column_sign == 1:
        rests = p.friction.set_valued != 0 and mode.column == 0
        mu = signed_coefficient(motion.along, mode.column, mode.clock, y, p)
        now = contacts.column_reactions(free, w, rests, mu)
    elif mode.bolster_sign == 1:
        rests = p.friction.set_valued != 0 and mode.bolster == 0
        mu = signed_coefficient(bolster_slip(motion, p), mode.bolster, mode.clock, y, p)
        now = contacts.bolster_reactions(free, w, rests, mu, p)
    guide = 0.0
    if rests_in_guide(mode, p):
        guide = contacts.guide_reaction(unheld, now, p)
    return contacts.motion_under(free, w, now, p), now, guide


@implement(interface.rate, UNILATERAL)
@inner
def rate(t, y, mode, p):
    """dy/dt, and the forces."""
    if closed(mode):
        of_closed, both = transitions.rate(t, without_gaps(y), mode, p)
        forces = UnilateralForces((0.0, 0.0), both.column, nan, both.bolster, nan, nan)
        return of_closed + (0.0, 0.0, 0.0, 0.0), forces  # noqa: RUF005
    motion, now, guide = _motion_and_reactions(t, y, mode, p)
    column = motion.gap if mode.column_sign == 0 else 0.0
    bolster = bolster_gap(motion, p) if mode.bolster_sign == 0 else 0.0
    forces = UnilateralForces(
        (column, bolster), now.column, now.column_friction, now.bolster, now.bolster_friction, guide
    )
    others = Accelerations(0.0, frame_acceleration(t, motion, y, p))
    own = hooks.rates(velocities(y, p).along, others, mode, y, p)
    gaps = y[COLUMN_RATE], column, y[BOLSTER_RATE], bolster
    return (y[VELOCITY], motion.rise) + own + gaps, forces  # noqa: RUF005


# Events


@inner
def _stuck_events(t, y, mode, p, out):
    """Write the events of a stuck bolster: margins (N) to slip or opening, and to the limits of friction."""
    free, highest = free_accelerations(t, y, mode.segment, 0, p), friction.static(1, y, p)
    rubs = guide_friction.acts(p)
    faces = contacts.Faces(True, True, False, highest, highest, rubs)
    out[2 * COLUMN] = -contacts.solve_unless_stuck(free, faces, p)[0].margin
    out[2 * COLUMN + 1] = contacts.sticking_reactions(free, highest, highest, rubs, p)[1]


@inlined
def _branch_events(slip, branch, most, reaction, axis, p, out):
    """Write the ends of the slip branch of an axis; at rest by its reaction and the ``most`` of it (N)."""
    place = 2 * axis
    if not p.friction.set_valued:
        friction.write_branch_ends(slip, p.friction.v_t, branch, place, out)
    elif branch == 0:
        out[place], out[place + 1] = most + reaction, most - reaction
    else:
        out[place if branch > 0 else place + 1] = branch * slip


@inner
def _open_events(now, y, mode, p, out):
    """Write the event functions while a contact is open."""
    motion, highest = velocities(y, p), friction.static(1, y, p)
    if guide_friction.acts(p):
        _branch_events(y[VELOCITY], mode.guide, p.guide_friction.force, now.guide, GUIDE, p, out)
    if mode.column_sign == 0:
        out[COLUMN_CLOSES] = y[COLUMN_GAP]
    else:
        out[COLUMN_NORMAL] = now.column
        most = highest * now.column
        _branch_events(motion.along, mode.column, most, now.column_friction, COLUMN, p, out)
    if mode.bolster_sign == 0:
        out[BOLSTER_CLOSES] = y[BOLSTER_GAP]
    else:
        out[BOLSTER_NORMAL] = now.bolster
        slip, most = bolster_slip(motion, p), highest * now.bolster
        _branch_events(slip, mode.bolster, most, now.bolster_friction, BOLSTER, p, out)
    if travel.acts(p):
        travel.write_events(y[X], mode.segment, p, TRAVEL, out)


@implement(interface.events, UNILATERAL)
@inner
def all_events(now, t, y, mode, p, out):
    """Write the event functions (m/s, m, N) under the reactions ``now``."""
    if stuck(mode, p) or not closed(mode):
        for i in range(EVENTS):
            out[i] = inf
    if stuck(mode, p):
        _stuck_events(t, y, mode, p, out)
    elif closed(mode):
        events.events(now, t, without_gaps(y), mode, p, out)
        if held(mode):  # by a jump of friction: the forces are those of its convex combination
            both = filippov.filippov_forces(t, without_gaps(y), mode, p)[0]
            out[COLUMN_NORMAL], out[BOLSTER_NORMAL] = both.column, both.bolster
    else:
        _open_events(now, y, mode, p, out)


@inlined
def _time_to_close(gap, rate, acceleration):
    """Time (s) in which a gap closes at a constant acceleration; inf: never.

    A closed gap stays closed; the acceleration of one that opens just now is no more than rounding errors.
    """
    square = rate * rate - 2.0 * gap * acceleration
    if square < 0.0 or (rate >= 0.0 and acceleration >= 0.0) or gap == rate == 0.0:
        return inf
    if rate < 0.0:
        return 2.0 * gap / (sqrt(square) - rate)
    return (rate + sqrt(square)) / -acceleration


@implement(interface.expected_event, UNILATERAL)
@inlined
def expected_event(now, t, y, mode, p):
    """Time (s) in which an open face would close."""
    column, bolster = now.gap_accelerations
    return min(
        _time_to_close(y[COLUMN_GAP], y[COLUMN_RATE], column),
        _time_to_close(y[BOLSTER_GAP], y[BOLSTER_RATE], bolster),
    )


@implement(interface.event, UNILATERAL)
@inner
def event(place, t, y, mode, p, out):
    """One of them."""
    all_events(rate(t, y, mode, p)[1], t, y, mode, p, out)
    return out[place]


# Modes


@implement(interface.initial_mode, UNILATERAL)
@inner
def initial_mode(t, y, p):
    """Mode in which a run begins, and whether it is unique."""
    if not (is_open(y)[0] or is_open(y)[1]):
        mode, unique = transitions.initial_mode(t, without_gaps(y), p)
        if unique and stays_closed(without_gaps(y), mode, p):
            return mode, True
    return _of_state(t, y, p)


@inlined
def _of_state(t, y, p):
    """The mode of a state whose contacts may open, and whether it is unique."""
    return resolve(t, y, touching(y, travel.segment_at(y[X], p), p), p)


@inlined
def _at_rest(mode, place):
    """The mode with what came to rest, or let go, at an event: two closed faces and the guide do together."""
    if not closed(mode):
        return replaced(mode, place // 2, 0)
    return replaced(replaced(replaced(mode, COLUMN, 0), BOLSTER, 0), GUIDE, 0)


@implement(interface.well_posed, UNILATERAL)
@inner
def well_posed(t, y, mode, p):
    """Whether exactly one mode is possible."""
    if p.geometry.always_well_posed or stays_closed(without_gaps(y), mode, p):
        return True
    if held(mode):
        return filippov.resolve_mode(t, without_gaps(y), mode, p)[2]
    return resolve(t, y, mode, p)[1]


@inner
def _after_slip(t, y, mode, place, p):
    """State and mode at the end of a slip branch, or of sticking, and whether they are unique."""
    if p.friction.set_valued:
        if closed(mode) or place // 2 == GUIDE:
            y = replaced(y, VELOCITY, 0.0)
        found, certain = resolve(t, y, _at_rest(mode, place), p)
        # If sticking ends and the bolster sticks again at once, friction has only touched its limit. That is
        # accepted where every state is proved to be well-posed; elsewhere the case counts as locked.
        again = stuck(mode, p) and stuck(found, p)
        return y, found, certain and (not again or p.geometry.always_well_posed != 0)
    if not closed(mode):
        axis = place // 2
        return y, with_branch(mode, axis, mode[axis] + 2 * (place % 2) - 1, p), True
    across, certain = transitions.cross_discontinuity(t, without_gaps(y), mode, place, p)
    if closed(across) and certain:
        return y, across, True
    found, certain = resolve(t, y, without_jump(t, y, with_signs(across, 1, 1), p), p)
    return y, found, certain


@implement(interface.transition, UNILATERAL)
@inner
def transition(t, y, mode, place, p):
    """State and mode after an event, and whether they are unique (if not: locked).

    Joints that can open lock where bilateral ones do not, and the other way round: a normal force that pulls
    is no solution. Where bilateral joints know of none or of several modes, the others have to find it.
    """
    first = without_gaps(y)
    if stays_closed(first, mode, p):
        first, found, unique = transitions.transition(t, first, mode, place, p)
        y = with_first(y, first)
        if not (unique and stays_closed(first, found, p)):
            found, unique = _opening(t, y, found, unique, p)
        return y, found, unique
    return _of_opening(t, y, mode, place, p)


@inner
def _opening(t, y, mode, unique, p):
    """Mode in place of one in which bilateral joints do not surely carry load, and whether it is unique.

    A mode in which a jump of friction holds a velocity is the same for both, if bilateral joints are sure of
    it.
    """
    if p.friction.set_valued:
        return _of_state(t, y, p)
    if held(mode) and closed(mode) and unique:
        return mode, True
    return resolve(t, y, without_jump(t, y, with_signs(mode, 1, 1), p), p)


@inner
def _of_opening(t, y, mode, place, p):
    """As ``transition``, from a mode in which a contact is open, or may open."""
    if place in (TRAVEL, TRAVEL + 1):
        return y, replaced(mode, SEGMENT, travel.next_segment(mode.segment, place % 2, p)), True
    if place in (COLUMN_CLOSES, BOLSTER_CLOSES):
        after = impact.closing(y, mode, place, p)
        found, certain = resolve(t, after.y, touching(after.y, mode.segment, p), p)
        return after.y, found, certain and after.unique
    if place >= COLUMN_NORMAL:
        found, certain = resolve(t, y, without_jump(t, y, mode, p), p)
        return y, found, certain
    return _after_slip(t, y, mode, place, p)


@implement(interface.impact, UNILATERAL)
@inner
def of_impact(y, mode, place, p):
    """Whether an event is an impact, its largest normal impulse (N s) and the energy that it takes (J)."""
    if place not in (COLUMN_CLOSES, BOLSTER_CLOSES):
        return False, 0.0, 0.0
    now = impact.closing(y, mode, place, p)
    lost = kinetic_energy(y, p) - kinetic_energy(now.y, p)
    return True, max(now.impulses.column, now.impulses.bolster), lost


# Forces and energy


@implement(interface.powers, UNILATERAL)
@inner
def powers(t, y, mode, p):
    """Power taken and supplied, and the normal forces; not determined while set-valued friction holds."""
    if closed(mode):
        return bilateral.powers(t, without_gaps(y), mode, p)
    _, now, _ = _motion_and_reactions(t, y, mode, p)
    motion = velocities(y, p)
    faces = now.column_friction * motion.along + now.bolster_friction * bolster_slip(motion, p)
    of_guide = guide_friction.force(y[VELOCITY], mode.guide, p) * y[VELOCITY]
    supplied = -excitation.acceleration(t, p) * momentum_against_table(y, p)
    return 2.0 * faces - of_guide + energy.damping_power(y, p), supplied, now.column, now.bolster
