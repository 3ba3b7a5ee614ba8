"""Time at which a bolster that set-valued friction holds breaks away, without integration (base model).

While it sticks only the base moves, so that the event functions are known functions of time. As long as both
normal forces stay positive the time of breakaway has a closed form. Elsewhere the event functions are
sampled, and a minimum is sought between samples where it may be negative.
"""

from math import asin, ceil, inf, nan, pi
from typing import Any, NamedTuple

import numpy as np

from wedgesweep.compiled import allocating, inlined, inner
from wedgesweep.effects import fixture_resonance
from wedgesweep.hybrid.search import Bracket, minimum, searched, zero
from wedgesweep.hybrid.state import HANDED_OVER, LOCKED, NO_EVENT
from wedgesweep.systems.suspension.events import EVENTS, events
from wedgesweep.systems.suspension.modes import COLUMN
from wedgesweep.systems.suspension.newton import UNDETERMINED
from wedgesweep.systems.suspension.set_valued import breakaway_input
from wedgesweep.systems.suspension.transitions import well_posed
from wedgesweep.trigonometry import sine

SAMPLES_PER_PERIOD = 64
# Error of a time, as a share of the interval between samples.
TIME_ERROR = 1e-13
DOWN, UP = 2 * COLUMN, 2 * COLUMN + 1


class _StuckBolster(NamedTuple):
    """A bolster at rest, with room for event functions."""

    y: tuple
    mode: tuple
    p: Any
    out: Any


@inlined
def _smallest(values):
    """Index of the smallest value."""
    place = 0
    for i in range(1, values.size):
        if values[i] < values[place]:
            place = i
    return place


@searched(_StuckBolster)
@inner
def _lowest(t, stuck):
    """Smallest event function at time t."""
    events(UNDETERMINED, t, stuck.y, stuck.mode, stuck.p, stuck.out)
    return stuck.out[_smallest(stuck.out)], nan


@inner
def breakaway_range(y, segment, p):
    """Base accelerations (m/s^2) below which a stuck bolster slips up, and above which it slips down.

    Also whether both faces carry load between them; else the bolster may leave in another way.
    """
    forward, backward = breakaway_input(y, 1, segment, p), breakaway_input(y, -1, segment, p)
    return forward, backward, p.geometry.always_well_posed != 0 and forward < backward


@inlined
def carries_load_until_breakaway(y, segment, p):
    """Whether both faces carry load until a stuck bolster breaks away, whatever its direction.

    On a compliant table the side frame moves, and with it the load: nothing is known in advance.
    """
    if fixture_resonance.acts(p):
        return False
    return breakaway_range(y, segment, p)[2]


@inner
def breakaway_time(state, stop, p):
    """Time at which a stuck bolster breaks away, and the event.

    The event is NO_EVENT if nothing happens before ``stop``, LOCKED where breakaway is not unique, and
    HANDED_OVER where a contact of unilateral joints may open. The bolster sticks between two base
    accelerations. With positive normal forces these are known, and so are the phases at which a harmonic base
    motion reaches them.
    """
    forward, backward, loaded = breakaway_range(state.y, state.mode.segment, p)
    if not loaded:
        if p.geometry.opens:
            return state.t, HANDED_OVER
        return scanned_breakaway(state, stop, p)
    return breakaway_between(forward, backward, state.t, stop, p)


@inner
def breakaway_between(forward, backward, t, stop, p):
    """As ``breakaway_time``, from the base accelerations below and above which the bolster slips (m/s^2).

    It slips up below ``forward``, and down above ``backward``.
    """
    omega = p.input.omega
    most = p.input.amplitude * omega**2
    upper, lower = -forward / most, -backward / most  # of sin(omega t)
    phase = omega * t
    if sine(phase) > upper:
        return t, UP
    if sine(phase) < lower:
        return t, DOWN
    turn = 2.0 * pi
    rising = falling = inf
    if upper < 1.0:
        rising = asin(upper)
        rising += turn * ceil((phase - rising) / turn)
    if lower > -1.0:
        falling = pi - asin(lower)
        falling += turn * ceil((phase - falling) / turn)
    moment = min(rising, falling) / omega
    if moment >= stop:
        return stop, NO_EVENT
    return moment, UP if rising < falling else DOWN


@allocating
def scanned_breakaway(state, stop, p):
    """As ``breakaway_time``, from samples: for any base motion and for normal forces of either sign."""
    out = np.empty(EVENTS)
    context = _StuckBolster(state.y, state.mode, p, out)
    step = 2.0 * np.pi / p.input.omega / SAMPLES_PER_PERIOD
    earlier, current = state.t, state.t
    before, now = inf, _lowest(current, context)[0]
    while current < stop:
        if not well_posed(current, state.y, state.mode, p):
            return current, LOCKED
        following = min(current + step, stop)
        after = _lowest(following, context)[0]
        if after > 0.0 and before > now and now < after:
            lowest = minimum(context, earlier, following, TIME_ERROR * step)
            value = _lowest(lowest, context)[0]
            if value < 0.0:
                current, now, following, after = earlier, before, lowest, value
        if after < 0.0:
            moment = current
            if now > 0.0:
                moment = zero(context, Bracket(current, now, following, after), TIME_ERROR * step)
            _lowest(moment, context)
            return moment, _smallest(out)
        earlier, before = current, now
        current, now = following, after
    return stop, NO_EVENT
