"""Stick-slip of the base model under set-valued friction, as long as both faces stay closed.

The same few oscillators hold for all pieces of a run: slip in either direction, and the verge of it (with
the static coefficient). With the state and the base acceleration at an event they say what follows. Where
that is in doubt, or a normal force vanishes, the event is handed on to the general ``transition``.
"""

from typing import Any, NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.excitation import acceleration
from wedgesweep.hybrid.recorder import record_constant
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.systems.suspension.first_event import slide
from wedgesweep.systems.suspension.linear_slip import Oscillator, forces_at, oscillator
from wedgesweep.systems.suspension.linear_slip_sums import record_slip
from wedgesweep.systems.suspension.modes import COLUMN, ContactMode, slipping, stuck
from wedgesweep.systems.suspension.newton import ROUNDING
from wedgesweep.systems.suspension.release import UP, release, release_between
from wedgesweep.systems.suspension.set_valued import LOOK_AHEAD

# Pieces after which the integrator counts the events.
MOST_PIECES = 1000


class _Direction(NamedTuple):
    """A direction of slip: its mode, the oscillator of it, and that on the verge of it."""

    mode: Any
    slip: Oscillator
    verge: Oscillator


@inlined
def _direction(sign, y, segment, p):
    mode = slipping(sign, segment, 0, p)
    slip = oscillator(y, mode, p)
    if friction.static(1, y, p) == friction.sliding(0.0, p):
        return _Direction(mode, slip, slip)
    return _Direction(mode, slip, oscillator(y, slipping(sign, segment, 1, p), p))


@inlined
def _linear(one):
    return one.slip.linear and one.verge.linear


@inlined
def _smallest(p):
    """Normal force (N) below which its sign is in doubt."""
    return ROUNDING * p.suspension.bolster_mass * p.suspension.gravity


@inlined
def _after_slip(t, x, up, down, p):
    """Mode after the velocity has become zero, and whether it is certain."""
    u2 = acceleration(t, p)
    rising, first = forces_at(x, u2, up.verge)
    falling, second = forces_at(x, u2, down.verge)
    nearly_none = ROUNDING * (p.suspension.gravity + abs(u2))
    certain = min(first, second) > _smallest(p) and not (rising > 0.0 and falling < 0.0)
    if rising <= nearly_none and falling >= -nearly_none:
        return ContactMode(0, 0, 0, 1, 1, 0, up.mode.segment, 1), certain
    if rising > 0.0:
        return up.mode, certain and forces_at(x, u2, up.slip)[1] > _smallest(p)
    return down.mode, certain and forces_at(x, u2, down.slip)[1] > _smallest(p)


@inlined
def _after_release(t, x, event, up, down, p):
    """Mode after the bolster has broken away, and whether it is certain."""
    u2 = acceleration(t + LOOK_AHEAD / p.input.omega, p)
    if event == UP:
        certain = forces_at(x, u2, up.verge)[0] > 0.0
        return up.mode, certain and forces_at(x, u2, up.slip)[1] > _smallest(p)
    certain = forces_at(x, u2, down.verge)[0] < 0.0
    return down.mode, certain and forces_at(x, u2, down.slip)[1] > _smallest(p)


@inlined
def _limit(x, verge):
    """Base acceleration (m/s^2) at which a bolster at rest is on the verge of slip."""
    return verge.frequency**2 * (x - verge.centre) / verge.driven


@inner
def _rest(state, stop, up, down, p):
    """Time at which a bolster at rest breaks away, and the event."""
    x = state.y[0]
    forward, backward = _limit(x, up.verge), _limit(x, down.verge)
    least = min(forces_at(x, forward, up.verge)[1], forces_at(x, backward, down.verge)[1])
    if forward < backward and least > 0.0:
        return release_between(forward, backward, state.t, stop, p)
    return release(state, stop, p)


@inner
def _piece(state, stop, directions, p, keeping, recorder):
    """Follow a mode to its event or ``stop``; the state there, and the event or NO_EVENT."""
    up, down = directions
    if stuck(state.mode, p):
        end, event = _rest(state, stop, up, down, p)
        if keeping:
            record_constant(state.t, end, state.y, state.mode, recorder, p)
        return State(end, state.y, state.mode, state.last_event, state.step), event
    o = up.slip if state.mode.column > 0 else down.slip
    end, x, velocity, event = slide(state, stop, o, p)
    if keeping:
        record_slip(state, end, o, recorder, p)
    return State(end, (x, velocity), state.mode, state.last_event, state.step), event


@inner
def stick_slip(state, stop, p, keeping, recorder, counts):
    """Follow stick and slip to an event that is none of theirs, or to ``stop``.

    Returns whether that was possible, the state and the event or NO_EVENT.
    """
    segment = state.mode.segment
    directions = _direction(1, state.y, segment, p), _direction(-1, state.y, segment, p)
    if not (_linear(directions[0]) and _linear(directions[1])):
        return False, state, NO_EVENT
    up, down = directions
    for _ in range(MOST_PIECES):
        rested = stuck(state.mode, p)
        state, event = _piece(state, stop, directions, p, keeping, recorder)
        if event // 2 != COLUMN:
            return True, state, event
        x = state.y[0]
        if rested:
            mode, certain = _after_release(state.t, x, event, up, down, p)
        else:
            mode, certain = _after_slip(state.t, x, up, down, p)
        if not certain:
            return True, state, event
        counts[2] += 1
        state = State(state.t, (x, 0.0), mode, event, state.step)
    return True, state, NO_EVENT
