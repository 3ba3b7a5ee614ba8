"""Compiled functions of the suspension as Python calls them: states are tuples, records those of ``compact``.

Compiled once for each type of record, as solvers compile them.
"""

from inspect import signature

import numpy as np

from wedgesweep import friction
from wedgesweep.compiled import borrowed, compiled, function_of
from wedgesweep.effects import states
from wedgesweep.hybrid import linear_modes
from wedgesweep.hybrid.accumulators import empty
from wedgesweep.hybrid.recorder import Recorder
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.hybrid.step import dense_output
from wedgesweep.solvers import explicit, implicit, period_detection
from wedgesweep.solvers.integrate import workspace
from wedgesweep.systems.suspension import (
    filippov,
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


def exposed(inner):
    """A function of compiled code as Python calls it."""
    arguments = list(signature(inner.py_func).parameters)
    function = function_of(arguments, f"inner({', '.join(arguments)})", inner=inner)
    # Kept code is found by these.
    function.__module__, function.__qualname__ = __name__, f"{inner.py_func.__module__}.{inner.__name__}"
    return compiled(function)


initial_mode = exposed(transitions.initial_mode)
rate = exposed(transitions.rate)
transition = exposed(transitions.transition)
resolve_mode = exposed(filippov.resolve_mode)
contact_forces = exposed(filippov.forces_of_mode)
reactions = exposed(newton.reactions)
loaded_reactions = exposed(newton._loaded_reactions)
breakaway = exposed(set_valued.acceleration_on_breakaway)
growth = exposed(stiffness.growth)
branch_at = exposed(friction.branch_at)
detected_period = exposed(period_detection.detected_period)


@compiled
def coefficient(velocity, branch, y, p):
    """Signed coefficient of the law on a branch."""
    return friction.coefficient(velocity, branch, friction.static(0, y, p), p)


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
def _slid(t, stop, y, mode, p, recorder, work):
    _, end, event = linear_modes.follow_linear(
        State(t, y, mode, NO_EVENT, 0.0), stop, p, False, recorder, borrowed(work)
    )
    return end.t, end.y, event


NOTHING_RECORDED = Recorder(
    *(0.0, 1.0, False, False, empty(), np.zeros(0), np.zeros(0)),
    *(np.zeros((2, 0)), np.zeros(0, bool), np.zeros(0)),
)


def slid(t, stop, y, mode, p):
    """Where a linear mode ends: time, state and event."""
    return _slid(t, stop, y, mode, p, NOTHING_RECORDED, workspace(1e-6))
