"""Stick-slip of the base model under set-valued friction, as long as both faces stay closed.

The same four oscillators hold throughout a run: slip in either direction, and the verge of it (with the
static coefficient). With the displacement and the base acceleration at an event they say which mode follows.
Where that is in doubt, or a normal force vanishes, the event is left to the general ``transition``.
"""

from typing import Any, NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.excitation import acceleration
from wedgesweep.hybrid.recorder import record_constant
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.systems.suspension.breakaway import UP, breakaway_between
from wedgesweep.systems.suspension.first_event import slip_to_event
from wedgesweep.systems.suspension.linear_slip import (
    LinearOscillator,
    acceleration_at,
    base_acceleration,
    input_turn,
    linear_oscillator,
    motion,
    phase_of,
    smaller_force_at,
)
from wedgesweep.systems.suspension.linear_slip_sums import record_slip
from wedgesweep.systems.suspension.modes import COLUMN, ContactMode, slipping, stuck
from wedgesweep.systems.suspension.newton import ROUNDING
from wedgesweep.systems.suspension.set_valued import LOOK_AHEAD

# Modes after which the integrator checks the number of events.
MOST_MODES = 1000


class _Direction(NamedTuple):
    """A direction of slip: its mode, the oscillator of that mode, and the one on the verge of slip."""

    mode: Any
    slip: LinearOscillator
    verge: LinearOscillator


@inlined
def _direction(sign, y, segment, p):
    mode = slipping(sign, segment, 0, p)
    slip = linear_oscillator(y, mode, p)
    if friction.static(1, y, p) == friction.sliding(0.0, p):
        return _Direction(mode, slip, slip)
    return _Direction(mode, slip, linear_oscillator(y, slipping(sign, segment, 1, p), p))


@inlined
def _linear(one):
    return one.slip.linear and one.verge.linear


@inlined
def _rounding(p):
    """Normal force (N) below which its sign is in doubt."""
    return ROUNDING * p.suspension.bolster_mass * p.suspension.gravity


@inlined
def _after_slip(x, u2, up, down, p):
    """Mode after the velocity has become zero, and whether it is certain; ``u2``: of the base (m/s^2)."""
    rising, falling = acceleration_at(x, u2, up.verge), acceleration_at(x, u2, down.verge)
    smallest = min(smaller_force_at(x, u2, up.verge), smaller_force_at(x, u2, down.verge))
    nearly_none = ROUNDING * (p.suspension.gravity + abs(u2))
    certain = smallest > _rounding(p) and not (rising > 0.0 and falling < 0.0)
    if rising <= nearly_none and falling >= -nearly_none:
        return ContactMode(0, 0, 0, 1, 1, 0, up.mode.segment, 1), certain
    if rising > 0.0:
        return up.mode, certain and smaller_force_at(x, u2, up.slip) > _rounding(p)
    return down.mode, certain and smaller_force_at(x, u2, down.slip) > _rounding(p)


@inlined
def _after_breakaway(t, x, event, up, down, p):
    """Mode after the bolster has broken away, and whether it is certain."""
    u2 = acceleration(t + LOOK_AHEAD / p.input.omega, p)
    if event == UP:
        certain = acceleration_at(x, u2, up.verge) > 0.0
        return up.mode, certain and smaller_force_at(x, u2, up.slip) > _rounding(p)
    certain = acceleration_at(x, u2, down.verge) < 0.0
    return down.mode, certain and smaller_force_at(x, u2, down.slip) > _rounding(p)


@inlined
def _breakaway_input(x, verge):
    """Base acceleration (m/s^2) at which a bolster at rest is on the verge of slip."""
    return verge.frequency**2 * (x - verge.centre) / verge.driven


@inlined
def _breakaway_range(x, up, down):
    """As ``breakaway.breakaway_range``, from the oscillators on the verge of slip."""
    forward, backward = _breakaway_input(x, up), _breakaway_input(x, down)
    smallest = min(smaller_force_at(x, forward, up), smaller_force_at(x, backward, down))
    return forward, backward, forward < backward and smallest > 0.0


@inlined
def _slip(state, phase, stop, oscillator, p, keeping, recorder):
    """Follow slip, which begins at a phase, to its end or ``stop``: a ``SlipEnd``."""
    end = slip_to_event(state, phase, stop, oscillator, p)
    if keeping:
        record_slip(state, phase, end.t, oscillator, recorder, p)
    return end


@inner
def stick_slip(state, stop, p, keeping, recorder, counts):
    """Follow stick and slip to an event that another mode follows, or to ``stop``.

    Returns whether both directions of slip are linear oscillators whose faces carry load until a breakaway,
    the state, and the event or NO_EVENT.
    """
    segment = state.mode.segment
    up, down = _direction(1, state.y, segment, p), _direction(-1, state.y, segment, p)
    if not (_linear(up) and _linear(down)):
        return False, state, NO_EVENT
    turn = input_turn(state.t, p)
    for _ in range(MOST_MODES):
        x, velocity = state.y
        if stuck(state.mode, p):
            forward, backward, loaded = _breakaway_range(x, up.verge, down.verge)
            if not loaded:
                return False, state, NO_EVENT
            t, event = breakaway_between(forward, backward, state.t, stop, p)
            if keeping:
                record_constant(state.t, t, state.y, state.mode, recorder, p)
            if event // 2 == COLUMN:
                mode, certain = _after_breakaway(t, x, event, up, down, p)
            turn = input_turn(t, p)
        else:
            oscillator = up.slip if state.mode.column > 0 else down.slip
            phase = phase_of(turn, x, velocity, oscillator, p)
            t, phase, event = _slip(state, phase, stop, oscillator, p, keeping, recorder)
            x, velocity = motion(phase, oscillator, p)
            turn = phase.cosine, phase.sine
            if event // 2 == COLUMN:
                mode, certain = _after_slip(x, base_acceleration(phase, p), up, down, p)
        if event // 2 != COLUMN or not certain:
            return True, State(t, (x, velocity), state.mode, state.last_event, state.step), event
        counts[2] += 1
        state = State(t, (x, 0.0), mode, event, state.step)
    return True, state, NO_EVENT
