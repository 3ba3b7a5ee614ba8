"""The suspension's own methods, one mode after the other: closed forms and power series.

An integrator that got the state back after each mode would take a tenth more time.
"""

from wedgesweep.compiled import inlined, inner
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.interface import implement, leaves, linear, transition
from wedgesweep.hybrid.linear_modes import follow_linear
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.systems.suspension.events import COLUMN_NORMAL
from wedgesweep.systems.suspension.modes import stuck
from wedgesweep.systems.suspension.series_slip import follow_series, has_series
from wedgesweep.systems.suspension.sticking import follow_stuck

# Modes after which the integrator checks the number of events.
MOST_MODES = 1000


@inlined
def _follow_mode(state, stop, p, keeping, recorder, work):
    """As ``follow``, one mode."""
    if stuck(state.mode, p):
        return follow_stuck(state, stop, p, keeping, recorder, work)
    if linear(state.mode, p):
        return follow_linear(state, stop, p, keeping, recorder, work)
    if has_series(state.mode, p):
        return follow_series(state, stop, p, keeping, recorder, work)
    return False, state, NO_EVENT


@implement(interface.follow, "suspension")
@inner
def follow(state, stop, p, keeping, recorder, work):
    """See the interface."""
    for _ in range(MOST_MODES):
        done, state, event = _follow_mode(state, stop, p, keeping, recorder, work)
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
