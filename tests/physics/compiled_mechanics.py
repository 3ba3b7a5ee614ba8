"""Compiled functions of the suspension as Python calls them: states are tuples, records those of ``compact``.

Compiled once for each type of record, as solvers compile them.
"""

from wedgesweep import friction
from wedgesweep.compiled import compiled
from wedgesweep.effects import states
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.hybrid.step import dense_output
from wedgesweep.solvers import explicit, implicit, period_detection
from wedgesweep.systems.suspension import (
    filippov,
    first_event,
    linear_slip,
    newton,
    parameters,
    set_valued,
    stiffness,
    transitions,
)


def with_all_mechanics(record):
    """The same case, as compiled code gets it, with room for every effect."""
    full = record.copy()
    full["geometry"]["kit"] = parameters.ALL
    return parameters.compact(full)


def initial_state(p, values=()):
    """A state vector (tuple) of a record with 0 but for ``values`` by (owner, number); owner "": the mass."""
    owners = [owner for owner, _ in states.kinds(p.dtype.fields)]
    y = [0.0] * len(owners)
    for (owner, number), value in dict(values).items():
        y[owners.index(owner) + number] = float(value)
    return tuple(y)


def owned(y, p):
    """Numbers of a state vector by the effect that owns them; "": the mass."""
    by_owner = {}
    for (owner, _), value in zip(states.kinds(p.dtype.fields), y, strict=True):
        by_owner.setdefault(owner, []).append(value)
    return by_owner


@compiled
def initial_mode(t, y, p):
    """Mode at the start of a run, and whether it is unique."""
    return transitions.initial_mode(t, y, p)


@compiled
def rate(t, y, mode, p):
    """dy/dt, a tuple, and the forces."""
    return transitions.rate(t, y, mode, p)


@compiled
def resolve_mode(t, y, mode, p):
    """Mode with the signs of its normal forces, the forces, and whether they are unique."""
    return filippov.resolve_mode(t, y, mode, p)


@compiled
def contact_forces(t, y, mode, p):
    """Forces on any mode but a stuck one."""
    return filippov.forces_of_mode(t, y, mode, p)


@compiled
def reactions(load, mu, p):
    """Forces under loads and coefficients of friction, and the determinant of their equations."""
    return newton.reactions(load, mu, p)


@compiled
def loaded_reactions(load, column_mu, bolster_mu, p):
    """The same with coefficients that depend on the load."""
    return newton._loaded_reactions(load, column_mu, bolster_mu, p)


@compiled
def breakaway(t, y, direction, segment, p):
    """Acceleration z'' (m/s^2) if set-valued friction let go in a direction."""
    return set_valued.acceleration_on_breakaway(t, y, direction, segment, p)


@compiled
def growth(by_state, p):
    """Rate (1/s) at which velocities run away."""
    return stiffness.growth(by_state, p)


@compiled
def coefficient(velocity, branch, y, p):
    """Signed coefficient of the law on a branch."""
    return friction.coefficient(velocity, branch, friction.static(0, y, p), p)


@compiled
def branch_at(speed, p):
    """Branch of a regularised law."""
    return friction.branch_at(speed, p)


@compiled
def explicit_step(t, h, y, mode, p, rtol):
    """State at the end of an explicit step and in its middle, and the error over the tolerance."""
    made, _, _, error = explicit.step(t, h, y, transitions.rate(t, y, mode, p)[0], mode, p, rtol)
    return made.end, dense_output(0.5, made), error


@compiled
def implicit_step(t, h, y, mode, p, rtol):
    """State at the end of an implicit step and in its middle, and the error over the tolerance."""
    made, _, _, error = implicit.step(t, h, y, transitions.rate(t, y, mode, p)[0], mode, p, rtol)
    return made.end, dense_output(0.5, made), error


@compiled
def detected_period(distances, tolerance):
    """Periods after which a state came back."""
    return period_detection.detected_period(distances, tolerance)


@compiled
def slid(t, stop, y, mode, p):
    """Oscillator of a mode, and where it ends: time and event."""
    oscillator = linear_slip.linear_oscillator(y, mode, p)
    phase = linear_slip.phase_at(t, y[0], y[1], oscillator, p)
    end = first_event.slip_to_event(State(t, y, mode, NO_EVENT, 0.0), phase, stop, oscillator, p)
    return oscillator, end.t, end.event
