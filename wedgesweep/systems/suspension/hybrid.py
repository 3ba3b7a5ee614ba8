"""The suspension as a hybrid system: what solvers ask of it, see hybrid/interface.py."""

from math import nan

from wedgesweep import excitation, friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import guide_friction, presliding, states
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.interface import implement
from wedgesweep.hybrid.state import NO_EVENT
from wedgesweep.hybrid.vectors import replaced
from wedgesweep.systems.shared import implement_shared
from wedgesweep.systems.suspension import events, stiffness, transitions  # noqa: F401
from wedgesweep.systems.suspension.energy import damping_power, friction_power, supplied_power
from wedgesweep.systems.suspension.faces import column_slip
from wedgesweep.systems.suspension.filippov import filippov_forces
from wedgesweep.systems.suspension.modes import VELOCITY, X, held, stuck
from wedgesweep.systems.suspension.newton import UNDETERMINED, driving_force, forces
from wedgesweep.systems.suspension.series_slip import follow_series, has_series
from wedgesweep.systems.suspension.sticking import follow_stuck

SUSPENSION = "suspension"

for _declared, _written in (
    (interface.initial_mode, transitions.initial_mode),
    (interface.rate, transitions.rate),
    (interface.transition, transitions.transition),
    (interface.well_posed, transitions.well_posed),
    (interface.events, events.events),
    (interface.event, events.event),
    (interface.expected_event, events.expected_event),
    (interface.holds, stuck),
    (interface.fastest, excitation.fastest),
):
    implement(_declared, SUSPENSION)(_written)

implement_shared(SUSPENSION)


@implement(interface.event_count, SUSPENSION)
@inlined
def event_count(p):
    """Number of event functions."""
    return events.EVENTS


@implement(interface.never_locks, SUSPENSION)
@inlined
def never_locks(p):
    """See parameters.prepare."""
    return p.geometry.always_well_posed != 0


@implement(interface.linear, SUSPENSION)
@inlined
def linear(mode, p):
    """Whether a mode slips on all faces under friction that does not depend on velocity."""
    if not (p.geometry.linear and excitation.is_sine(p)) or held(mode):
        return False
    bolster = mode.bolster != 0 or p.geometry.bolster_ratio == 0.0
    guide = mode.guide != 0 or not guide_friction.acts(p)
    return mode.column != 0 and bolster and guide and friction.is_constant(p)


@implement(interface.follow, SUSPENSION)
@inlined
def follow(state, stop, p, keeping, recorder, work):
    """Rest in closed form, and power series."""
    if stuck(state.mode, p):
        return follow_stuck(state, stop, p, keeping, recorder, work)
    if has_series(state.mode, p):
        return follow_series(state, stop, p, keeping, recorder, work)
    return False, state, NO_EVENT


@implement(interface.free, SUSPENSION)
@inlined
def free(y, p):
    """A bolster that friction holds keeps its velocity."""
    pinned = p.friction.set_valued and y[VELOCITY] == 0.0
    return replaced(states.active(p), VELOCITY, not pinned)


@implement(interface.observed, SUSPENSION)
@inlined
def observed(y, p):
    """Displacement and velocity of the bolster against the side frame."""
    return y[X], y[VELOCITY]


@implement(interface.sticks, SUSPENSION)
@inlined
def sticks(y, mode, p):
    """Whether the column face is closed and sticks, or slips below v_t: bristles end no branch there."""
    if abs(mode.column) == 1 and presliding.acts(p) and not p.friction.set_valued:
        return abs(column_slip(y, p)) <= p.friction.v_t
    return abs(mode.column) != 1 and mode.column_sign != 0


@implement(interface.driving_force, SUSPENSION)
@inlined
def force_of_motion(t, acceleration, y, mode, p):
    """The force on the bolster; not determined while set-valued friction holds it."""
    return nan if stuck(mode, p) else driving_force(t, acceleration, y, mode, p)


@implement(interface.powers, SUSPENSION)
@inner
def powers(t, y, mode, p):
    """Power taken and supplied, and the normal forces."""
    now, power = UNDETERMINED, 0.0
    if held(mode):
        now, power, _ = filippov_forces(t, y, mode, p)
    elif not stuck(mode, p):
        now = forces(t, y, mode, p)
        power = friction_power(t, y, mode, now, p)
    supplied = supplied_power(excitation.acceleration(t, p), y, p)
    return power + damping_power(y, p), supplied, now.column, now.bolster
