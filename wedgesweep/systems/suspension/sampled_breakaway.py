"""Sticking under a sampled input without integration: the bolster rests between two base accelerations.

These are constant while nothing but the base moves and both faces carry load (breakaway.py).
"""

from wedgesweep import sampled_input
from wedgesweep.compiled import inner, term
from wedgesweep.effects import states, stray_vibration
from wedgesweep.hybrid.interface import follow, implement
from wedgesweep.hybrid.recorder import record_constant
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.systems.suspension.breakaway import DOWN, UP, breakaway_range
from wedgesweep.systems.suspension.modes import VELOCITY, stuck


@inner
def _waits_for_input(state, p):
    """Whether only a sampled motion of the base can end the mode."""
    if p.series.rows == 0 or not stuck(state.mode, p) or stray_vibration.acts(p):
        return False
    moving, rests = states.active(p), True
    for i in range(VELOCITY + 1, len(moving)):
        rests = rests and not moving[i]
    return rests


@implement(follow, "suspension")
@term("series", off="(False, state, NO_EVENT)", NO_EVENT=NO_EVENT)
def follow_stuck(state, stop, p, keeping, recorder, work):
    """See the interface: follows a bolster that sticks under a sampled input."""
    if not _waits_for_input(state, p):
        return False, state, NO_EVENT
    t, y, mode, last_event, step = state
    forward, backward, loaded = breakaway_range(y, mode.segment, p)
    if not loaded:
        return False, state, NO_EVENT
    size = p.input.amplitude
    end, side = sampled_input.bend_leaves(t, stop, forward / size, backward / size, p)
    if keeping:
        record_constant(t, end, y, mode, recorder, p)
    event = NO_EVENT if side == 0 else UP if side < 0 else DOWN
    return True, State(end, y, mode, last_event, step), event
