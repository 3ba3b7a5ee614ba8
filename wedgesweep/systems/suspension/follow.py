"""The base model's own methods: closed forms for sticking and linear slip, power series for other slip."""

from wedgesweep.compiled import inlined, inner
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.interface import implement, leaves, linear, transition
from wedgesweep.hybrid.linear_modes import follow_linear
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.systems.suspension.events import COLUMN_NORMAL
from wedgesweep.systems.suspension.modes import stuck
from wedgesweep.systems.suspension.regularised_slip import equations_of, follow_series, has_series
from wedgesweep.systems.suspension.sticking import follow_stuck

# Modes after which the integrator checks the number of events.
MOST_MODES = 1000


@inlined
def _follow_mode(state, stop, equations, p, keeping, recorder, work):
    """As ``follow``, one mode."""
    mode = state.mode
    if stuck(mode, p):
        return follow_stuck(state, stop, p, keeping, recorder, work)
    if linear(mode, p):
        return follow_linear(state, stop, p, keeping, recorder, work)
    if has_series(mode, p):
        return follow_series(state, stop, equations, p, keeping, recorder, work)
    return False, state, NO_EVENT


@implement(interface.follow, "base")
@inner
def follow(state, stop, p, keeping, recorder, work):
    """See the interface."""
    if not p.geometry.always_well_posed:
        return False, state, NO_EVENT
    equations = equations_of(state.mode, p)
    for _ in range(MOST_MODES):
        done, state, event = _follow_mode(state, stop, equations, p, keeping, recorder, work)
        if not done or event < 0 or event >= COLUMN_NORMAL:
            return done, state, event
        y, mode, certain = transition(state.t, state.y, state.mode, event, p)
        if not certain:
            return True, state, event
        work.counts[2] += 1
        state = State(state.t, y, mode, event, state.step)
        if leaves(y, mode, p):
            break
    return True, state, NO_EVENT
