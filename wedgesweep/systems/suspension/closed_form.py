"""Modes of the base model whose motion has a closed form: slip under constant friction, and sticking."""

from wedgesweep.compiled import inlined, inner
from wedgesweep.hybrid.interface import closed_form, implement
from wedgesweep.hybrid.recorder import record_constant
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.systems.suspension.breakaway import breakaway_time
from wedgesweep.systems.suspension.first_event import slip_to_event
from wedgesweep.systems.suspension.linear_slip import linear_oscillator, motion, phase_at
from wedgesweep.systems.suspension.linear_slip_sums import record_slip
from wedgesweep.systems.suspension.modes import stuck
from wedgesweep.systems.suspension.stick_slip import stick_slip


@inlined
def _faces_closed(mode):
    return mode.column_sign > 0 and mode.bolster_sign > 0


@implement(closed_form, "base")
@inner
def follow(state, stop, p, keeping, recorder, counts):
    """See the interface: stick-slip follows several modes, else this follows one."""
    if p.friction.set_valued and p.geometry.always_well_posed and _faces_closed(state.mode):
        done, state, event = stick_slip(state, stop, p, keeping, recorder, counts)
        if done:
            return True, state, event
    t, y, mode, last_event, step = state
    if stuck(mode, p):
        end, event = breakaway_time(state, stop, p)
        if keeping:
            record_constant(t, end, y, mode, recorder, p)
        return True, State(end, y, mode, last_event, step), event
    oscillator = linear_oscillator(y, mode, p)
    if not oscillator.linear:
        return False, state, NO_EVENT
    phase = phase_at(t, y[0], y[1], oscillator, p)
    end = slip_to_event(state, phase, stop, oscillator, p)
    if keeping:
        record_slip(state, phase, end.t, oscillator, recorder, p)
    return True, State(end.t, motion(end.phase, oscillator, p), mode, last_event, step), end.event
