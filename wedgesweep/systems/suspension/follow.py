"""The base model's own methods: closed forms for sticking and linear slip, power series for other slip."""

from wedgesweep.compiled import inlined, inner
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.interface import implement
from wedgesweep.hybrid.recorder import record_constant
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.systems.suspension.breakaway import breakaway_between, breakaway_range
from wedgesweep.systems.suspension.modes import stuck
from wedgesweep.systems.suspension.regularised_slip import follow_linear, follow_regularised
from wedgesweep.systems.suspension.stick_slip import stick_slip


@inlined
def _faces_closed(mode):
    return mode.column_sign > 0 and mode.bolster_sign > 0


@implement(interface.follow, "base")
@inner
def follow(state, stop, p, keeping, recorder, work):
    """See the interface."""
    if not p.friction.set_valued:
        return follow_regularised(state, stop, p, keeping, recorder, work)
    if p.geometry.always_well_posed and _faces_closed(state.mode):
        done, state, event = stick_slip(state, stop, p, keeping, recorder, work.counts)
        if done:
            return True, state, event
    if not stuck(state.mode, p):
        return follow_linear(state, stop, p, keeping, recorder)
    forward, backward, loaded = breakaway_range(state.y, state.mode.segment, p)
    if not loaded:
        # Joints that can open: ``leaves`` hands over to the other system. Others are integrated step by step.
        return p.geometry.opens != 0, state, NO_EVENT
    end, event = breakaway_between(forward, backward, state.t, stop, p)
    if keeping:
        record_constant(state.t, end, state.y, state.mode, recorder, p)
    return True, State(end, state.y, state.mode, state.last_event, state.step), event
