"""The mode in which a run begins, and the transition at each event."""

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import ageing, directional_friction, hooks, presliding, travel
from wedgesweep.excitation import acceleration
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.vectors import replaced, weighted
from wedgesweep.systems.shared import LOOK_AHEAD, ROUNDING, soon
from wedgesweep.systems.suspension import modes
from wedgesweep.systems.suspension.events import BOLSTER_NORMAL, CLOCK, COLUMN_NORMAL, TRAVEL
from wedgesweep.systems.suspension.faces import column_slip, slip_measure, slip_rate
from wedgesweep.systems.suspension.filippov import forces_of_mode, resolve_mode
from wedgesweep.systems.suspension.modes import (
    BOLSTER,
    COLUMN,
    DIRECTION,
    GUIDE,
    HELD,
    SEGMENT,
    VELOCITY,
    ContactMode,
    X,
    next_branch,
    slipping,
    stuck,
    with_branch,
)
from wedgesweep.systems.suspension.newton import Accelerations, solve_for_signs, stuck_forces
from wedgesweep.systems.suspension.set_valued import breakaway_direction, mode_at_zero_velocity
from wedgesweep.systems.suspension.unilateral.closed import are_unique


@inner
def rate(t, y, mode, p):
    """dy/dt, and the forces."""
    now = stuck_forces(t, y, mode, p) if stuck(mode, p) else forces_of_mode(t, y, mode, p)
    others = Accelerations(now.column_acceleration, now.frame_acceleration)
    own = hooks.rates(column_slip(y, p), others, mode, y, p)
    return (y[VELOCITY], now.acceleration) + own, now  # noqa: RUF005


@inlined
def _without_age(y, mode, p):
    """The state with the time at rest set to zero where it does not run."""
    return y if mode.clock else ageing.rejuvenated(y, p)


@inlined
def _velocity_soon(t, y, mode, p):
    """Velocity z' (m/s) a moment later."""
    return soon(t, y, LOOK_AHEAD / p.input.omega, mode, p)[VELOCITY]


@inner
def _with_direction(t, y, mode, p):
    """The mode with its sign of z', where friction depends on it, and whether it is unique."""
    if not directional_friction.acts(p):
        found, _, unique = solve_for_signs(t, y, mode, p)
        return found, unique
    upward, _, unique = solve_for_signs(t, y, with_branch(mode, DIRECTION, 1, p), p)
    if y[VELOCITY] > 0.0 or (y[VELOCITY] == 0.0 and _velocity_soon(t, y, upward, p) > 0.0):
        return upward, unique
    downward, _, unique = solve_for_signs(t, y, with_branch(mode, DIRECTION, -1, p), p)
    if y[VELOCITY] < 0.0 or _velocity_soon(t, y, downward, p) < 0.0:
        return downward, unique
    found, _, unique = resolve_mode(t, y, with_branch(mode, DIRECTION, HELD, p), p)
    return found, unique


@inner
def initial_mode(t, y, p):
    """Mode at the start of a run, and whether it is unique."""
    segment = travel.segment_at(y[X], p)
    if p.friction.set_valued:
        if y[VELOCITY] == 0.0:
            return mode_at_zero_velocity(t, y, segment, p)
        found, _, unique = solve_for_signs(t, y, slipping(1 if y[VELOCITY] > 0.0 else -1, segment, 0, p), p)
        return found, unique
    column = friction.branch_at(slip_measure(COLUMN, t, y, p), p)
    clock = 1 if column == 0 else 0
    if presliding.acts(p):
        clock = 1 if abs(column_slip(y, p)) <= p.friction.v_t else 0
        column = 1 if column_slip(y, p) >= 0.0 else -1
    bolster = friction.branch_at(slip_measure(BOLSTER, t, y, p), p)
    guide = friction.branch_at(y[VELOCITY], p)
    return _with_direction(t, y, ContactMode(column, bolster, guide, 0, 1, 1, segment, clock), p)


@inner
def well_posed(t, y, mode, p):
    """Whether exactly one pair of normal forces is possible; if not, the wedge locks.

    Of joints that can open: in a mode in which they surely stay closed (see ``unilateral/closed.py``).
    """
    if p.geometry.always_well_posed:
        return True
    if p.geometry.opens:
        return are_unique(y, mode, p)
    if stuck(mode, p):
        return mode_at_zero_velocity(t, y, mode.segment, p)[1]
    return resolve_mode(t, y, mode, p)[2]


@inner
def _after_zero_force(t, y, mode, p):
    """Mode after a normal force has become zero, and whether it is unique.

    Both forces may vanish at once, and a force may only touch zero; its sign at zero is noise. So the signs
    are those of a moment later, and of later moments as long as a force is no more than rounding errors.
    """
    ahead = LOOK_AHEAD / p.input.omega
    slope = interface.rate(t, y, mode, p)[0]
    found, certain = mode, True
    for _ in range(4):
        later = weighted(y, ahead, (1.0,), (slope,))
        later = replaced(later, X, later[X] + 0.5 * ahead * ahead * slope[VELOCITY])
        found, now, certain = solve_for_signs(t + ahead, later, mode, p)
        weight = p.suspension.bolster_mass * (p.suspension.gravity + abs(acceleration(t + ahead, p)))
        if min(abs(now.column), abs(now.bolster)) > ROUNDING * weight:
            break
        ahead *= 30.0
    return found, certain


@inner
def _continuous(axis, y, p):
    """Whether friction is continuous where one branch of an axis meets the next."""
    if axis >= GUIDE:
        return axis == GUIDE
    if axis == COLUMN and presliding.acts(p):
        return True
    jump = friction.static(0, y, p) - friction.sliding(p.friction.v_t, p)
    return not ageing.acts(p) and abs(jump) <= ROUNDING * p.friction.mu_d


@inner
def cross_discontinuity(t, y, mode, place, p):
    """Mode on the next branch, or held at the jump if the slip on the next branch accelerates back to it."""
    axis = place // 2
    was_held = abs(mode[axis]) == HELD
    across, now, certain = resolve_mode(t, y, next_branch(mode, place, False, p), p)
    onward = slip_rate(axis, t, y, now.acceleration, now.column_acceleration, p)
    if was_held or _continuous(axis, y, p) or (onward if place % 2 else -onward) >= 0.0:
        return across, certain
    found, _, certain = resolve_mode(t, y, next_branch(mode, place, True, p), p)
    return found, certain


@inlined
def _transition(t, y, mode, place, p):
    if place in (COLUMN_NORMAL, BOLSTER_NORMAL):
        found, certain = _after_zero_force(t, y, mode, p)
        return y, found, certain
    if place >= TRAVEL:
        if place == CLOCK:
            mode = replaced(mode, modes.CLOCK, 1 - mode.clock)
        else:
            mode = replaced(mode, SEGMENT, travel.next_segment(mode.segment, place % 2, p))
        found, _, certain = resolve_mode(t, y, mode, p)
        return y, found, certain
    if not p.friction.set_valued:
        found, certain = cross_discontinuity(t, y, mode, place, p)
        return y, found, certain
    y = replaced(y, VELOCITY, 0.0)
    if not stuck(mode, p):
        y = ageing.rejuvenated(y, p)
        found, certain = mode_at_zero_velocity(t, y, mode.segment, p)
        return y, found, certain
    direction = breakaway_direction(t, y, 1 if place == 2 * COLUMN + 1 else -1, mode.segment, p)
    found, _, certain = solve_for_signs(t, y, slipping(direction, mode.segment, 0, p), p)
    return y, found, certain


@inlined
def transition(t, y, mode, place, p):
    """State and mode after an event, and whether they are unique (if not: locked).

    The state changes where the event changes it: set-valued friction stops the bolster, slip ends the time
    at rest.
    """
    y, found, certain = _transition(t, y, mode, place, p)
    return _without_age(y, found, p), found, certain
