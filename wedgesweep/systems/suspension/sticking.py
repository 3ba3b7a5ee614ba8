"""Sticking without integration: set-valued friction holds the bolster until the base has accelerated enough.

While only the base moves, the bolster rests between two base accelerations. As long as both normal forces
stay positive these are known, and so are the times at which harmonics or a sampled motion reach them.
"""

from math import asin, ceil, inf, pi

from wedgesweep import excitation, sampled_input
from wedgesweep.compiled import inlined, inner, term
from wedgesweep.effects import fixture_resonance, input_distortion, stray_vibration
from wedgesweep.hybrid.interface import free
from wedgesweep.hybrid.recorder import record_constant
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.systems.suspension.modes import COLUMN, VELOCITY, stuck
from wedgesweep.systems.suspension.series_events import Ends, first_event
from wedgesweep.systems.suspension.set_valued import breakaway_input
from wedgesweep.trigonometry import sine

DOWN, UP = 2 * COLUMN, 2 * COLUMN + 1
# Error of a series of the base acceleration, as a share of the range in which the bolster rests.
ERROR = 1e-9


@inner
def _breakaway_range(y, segment, p):
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
    return _breakaway_range(y, segment, p)[2]


@inner
def _breakaway_of_sine(forward, backward, t, stop, p):
    """Time at which the acceleration of a sine leaves a range (m/s^2), and the event (NO_EVENT: none)."""
    omega = p.input.omega
    most = excitation.sine_amplitude(p) * omega**2
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


@inner
def _breakaway_of_harmonics(forward, backward, t, stop, p):
    """As ``_breakaway_of_sine``, of harmonics: by power series, one after the other."""
    ends = Ends(forward, UP, backward, DOWN)
    while t < stop:
        base = excitation.acceleration_expanded(t, p)
        longest = min(1.0 / p.input.omega, stop - t)
        last = (abs(base[-1]) * longest + abs(base[-2])) * longest ** (excitation.TERMS - 2)
        error = last / (ERROR * (backward - forward))
        h = longest if error <= 1.0 else longest * error ** (-1.0 / (excitation.TERMS - 2))
        time, event = first_event(base, h, NO_EVENT, ends, p)
        if event != NO_EVENT:
            return t + time, event
        t = stop if h == stop - t else t + h
    return stop, NO_EVENT


@term(
    "series", off="_breakaway_of_sine(forward, backward, t, stop, p)", _breakaway_of_sine=_breakaway_of_sine
)
def _breakaway(forward, backward, t, stop, p):
    """As ``_breakaway_of_sine``, of harmonics or samples."""
    if excitation.is_sine(p):
        return _breakaway_of_sine(forward, backward, t, stop, p)
    if excitation.is_harmonic(p):
        return _breakaway_of_harmonics(forward, backward, t, stop, p)
    size = excitation.amplitude(p)
    end, side = sampled_input.bend_leaves(t, stop, forward / size, backward / size, p)
    return end, NO_EVENT if side == 0 else UP if side < 0 else DOWN


@inner
def _waits_for_input(y, mode, p):
    """Whether only the motion of the base can end a mode, by what is known of it in advance."""
    if not stuck(mode, p) or stray_vibration.acts(p) or input_distortion.acts(p):
        return False
    moving, rests = free(y, p), True
    for i in range(VELOCITY + 1, len(y)):
        rests = rests and not moving[i]
    return rests


@inlined
def follow_stuck(state, stop, p, keeping, recorder, work):
    """As ``interface.follow``, for a bolster that sticks."""
    if not _waits_for_input(state.y, state.mode, p):
        return False, state, NO_EVENT
    forward, backward, loaded = _breakaway_range(state.y, state.mode.segment, p)
    # Outside the range it rests between joints that pull: these have a range of their own.
    if not (loaded and forward <= excitation.acceleration(state.t, p) <= backward):
        return False, state, NO_EVENT
    end, event = _breakaway(forward, backward, state.t, stop, p)
    if keeping:
        record_constant(state.t, end, state.y, state.mode, recorder, p)
    return True, State(end, state.y, state.mode, state.last_event, state.step), event
