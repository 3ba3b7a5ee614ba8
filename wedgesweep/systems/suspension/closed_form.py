"""Modes of the base model whose motion has a closed form: slip under constant friction, and sticking.

Joints that may open are bilateral ones as long as both contacts carry load: the base model follows them until
then, and hands over to the system of ``unilateral/``.
"""

from wedgesweep.compiled import inlined, inner
from wedgesweep.hybrid.interface import closed_form, implement, leaves, taken_over
from wedgesweep.hybrid.recorder import keep_constant
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.systems.suspension.first_event import slide
from wedgesweep.systems.suspension.linear_slip import oscillator
from wedgesweep.systems.suspension.linear_slip_sums import keep
from wedgesweep.systems.suspension.modes import held, mode_of, stuck
from wedgesweep.systems.suspension.release import is_known, release
from wedgesweep.systems.suspension.stick_slip import stick_slip


@inlined
def _faces_closed(mode):
    return mode.column_sign > 0 and mode.bolster_sign > 0


@implement(closed_form, "base")
@inner
def follow(state, stop, p, keeping, recorder, counts):
    """Follow a mode, and stick-slip, to its event or ``stop`` if it has a closed form."""
    if p.friction.set_valued and p.geometry.always_well_posed and _faces_closed(state.mode):
        done, state, event = stick_slip(state, stop, p, keeping, recorder, counts)
        if done:
            return True, state, event
    t, y, mode, last_event, step = state
    if stuck(mode, p):
        end, event = release(state, stop, p)
        if keeping:
            keep_constant(t, end, y, mode, recorder, p)
        return True, State(end, y, mode, last_event, step), event
    o = oscillator(y, mode, p)
    if not o.linear:
        return False, state, NO_EVENT
    end, x, velocity, event = slide(state, stop, o, p)
    if keeping:
        keep(state, end, o, recorder, p)
    return True, State(end, (x, velocity), mode, last_event, step), event


@inlined
def stays_closed(y, mode, p):
    """Whether both contacts surely carry load until a normal force reaches zero on the mode, or slip begins.

    In modes that a jump of friction holds the base model does not watch the normal forces.
    """
    loaded = _faces_closed(mode) and not held(mode) and p.geometry.always_well_posed != 0
    return loaded and (not stuck(mode, p) or is_known(y, p))


@implement(leaves, "base")
@inlined
def opens(y, mode, p):
    """Whether a contact of joints that may open does so, or may."""
    return p.geometry.opens != 0 and not stays_closed(y, mode, p)


@implement(taken_over, "base")
@inlined
def closes(t, y, mode, event, p):
    """The state and mode, as they were found by the system of ``unilateral/``."""
    return y, mode_of(mode), True


@implement(closed_form, "suspension")
@inlined
def no_closed_form(state, stop, p, keeping, recorder, counts):
    """No closed form: effects with their own mechanics are integrated."""
    return False, state, NO_EVENT
