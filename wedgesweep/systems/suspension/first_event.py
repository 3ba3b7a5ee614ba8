"""The first event of linear slip.

A scan with rotation matrices (no trigonometry) finds the interval of the first event, a safeguarded Newton
iteration the event itself, to rounding error. Normal forces are watched only if the amplitudes of the forced
and the free part of the motion allow them to vanish. The oscillator is in ``linear_slip.py``.
"""

from math import inf, pi, sqrt
from typing import Any, NamedTuple

from wedgesweep.compiled import inlined, inner
from wedgesweep.hybrid.search import Sample, crossing, first_zero, may_graze, searched
from wedgesweep.hybrid.state import NO_EVENT
from wedgesweep.systems.suspension.events import COLUMN_NORMAL
from wedgesweep.systems.suspension.linear_slip import (
    LinearOscillator,
    Phase,
    acceleration,
    advanced_briefly,
    force_sample,
    jerk,
    motion,
    rotated,
    small_angles,
    snap,
)

# Scanned intervals per period of input or free vibration, whichever is shorter.
SCAN = 16
# The event functions of an oscillator: slip velocity, and the normal forces on column and bolster.
SLIP, COLUMN_FORCE, BOLSTER_FORCE = 0, 1, 2
# Phase (rad) from which a series of order 3 leads to an event within rounding error.
CONVERGED = 2e-4


class _EventFunction(NamedTuple):
    """One of the event functions from a phase on."""

    which: int
    phase: Phase
    oscillator: LinearOscillator
    mode: tuple
    p: Any


@inlined
def _slip(phase, oscillator, mode, p):
    """How far |z'| is above the threshold at which the mode ends (m/s)."""
    return Sample(
        mode.column * motion(phase, oscillator, p)[1] - oscillator.threshold,
        mode.column * acceleration(phase, oscillator, p),
    )


@inlined
def _force(which, phase, oscillator, mode, p):
    """The normal force on a face (N), times the sign that it has on the mode."""
    force, sign = oscillator.column, mode.column_sign
    if which == BOLSTER_FORCE:
        force, sign = oscillator.bolster, mode.bolster_sign
    now = force_sample(force, phase, oscillator, p)
    return Sample(sign * now.value, sign * now.slope)


@inlined
def _sample(function, phase):
    """An event function at another phase."""
    if function.which == SLIP:
        return _slip(phase, function.oscillator, function.mode, function.p)
    return _force(function.which, phase, function.oscillator, function.mode, function.p)


@searched(_EventFunction)
@inlined
def _value(time, function):
    """An event function some time (s) after its phase, and its slope."""
    return _sample(function, advanced_briefly(function.phase, time, function.oscillator, function.p))


@inlined
def _least_force(sign, force, amplitude, oscillator, p):
    """Lower bound of a normal force (N), times its sign, while the mode lasts.

    ``amplitude`` (m): of the free part of x.
    """
    driven = force.by_x * oscillator.forced - force.by_u * p.input.amplitude * p.input.omega**2
    steady = force.at_rest + force.by_x * oscillator.centre
    return sign * steady - abs(driven) - abs(force.by_x) * amplitude


@inlined
def _forces_may_vanish(phase, oscillator, mode, p):
    """Whether a normal force may become zero on the mode."""
    amplitude = sqrt(phase.free**2 + phase.quadrature**2)
    column = _least_force(mode.column_sign, oscillator.column, amplitude, oscillator, p)
    return min(column, _least_force(mode.bolster_sign, oscillator.bolster, amplitude, oscillator, p)) <= 0.0


@inlined
def _end_of_slip(function, near):
    """Time at which slip ends, from a time near it, and whether that is within rounding error.

    Newton's method with two more terms of the series for time as a function of velocity.
    """
    oscillator, mode, p = function.oscillator, function.mode, function.p
    phase = advanced_briefly(function.phase, near, oscillator, p)
    value, slope = _slip(phase, oscillator, mode, p)
    newton = -value / slope
    second = -0.5 * mode.column * jerk(phase, oscillator, p) / slope
    third = 2.0 * second**2 - mode.column * snap(phase, oscillator, p) / (6.0 * slope)
    close = abs(newton) * max(p.input.omega, oscillator.frequency) < CONVERGED and slope < 0.0
    return near + newton * (1.0 + newton * (second + newton * third)), close


@inner
def _first_zero(function, before, after, span, from_zero):
    """As ``search.first_zero``."""
    if function.which == SLIP and after.value <= 0.0 < before.value and not from_zero:
        time, close = _end_of_slip(function, crossing(before, after, span))
        if close:
            return time
    return first_zero(function, 0.0, span, before, after, from_zero, 1.0 / function.p.input.omega)


@inlined
def _earlier(found, function, later, span, at_zero):
    """The first event so far, (time, which), or that of one more event function if it is earlier.

    ``at_zero``: the event function that begins at zero.
    """
    before, after = _sample(function, function.phase), _sample(function, later)
    if after.value > 0.0 and not may_graze(before, after, span):
        return found
    time = _first_zero(function, before, after, span, function.which == at_zero)
    return (time, function.which) if time < found[0] else found


class SlipEnd(NamedTuple):
    """Where a mode of slip ends, or a run stops: the time (s), the phase there, the event or NO_EVENT."""

    t: float
    phase: Phase
    event: int


@inlined
def _begins_at(state, oscillator):
    """Event function that is zero where a mode begins; -1 if none is."""
    # Either event of that face may have led to the mode: the one that ends it, or the end of a held jump.
    if state.y[1] == 0.0 or state.last_event // 2 == oscillator.event // 2:
        return SLIP
    return state.last_event - COLUMN_NORMAL + COLUMN_FORCE if state.last_event >= COLUMN_NORMAL else -1


# Inlined: an oscillator as an argument would be copied at every call.
@inlined
def slip_to_event(state, phase, stop, oscillator, p):
    """Follow slip from a state, whose phase is given, to its first event or ``stop``: a ``SlipEnd``."""
    t, mode, at_zero = state.t, state.mode, _begins_at(state, oscillator)
    step = 2.0 * pi / max(p.input.omega, oscillator.frequency) / SCAN
    turn = small_angles(step, oscillator, p)
    forces = at_zero >= COLUMN_FORCE or _forces_may_vanish(phase, oscillator, mode, p)
    while t < stop:
        span = min(step, stop - t)
        later = rotated(phase, *turn) if span == step else advanced_briefly(phase, span, oscillator, p)
        found = _earlier((inf, -1), _EventFunction(SLIP, phase, oscillator, mode, p), later, span, at_zero)
        if forces:
            for face in (COLUMN_FORCE, BOLSTER_FORCE):
                function = _EventFunction(face, phase, oscillator, mode, p)
                found = _earlier(found, function, later, span, at_zero)
        time, which = found
        if which >= 0:
            event = oscillator.event if which == SLIP else COLUMN_NORMAL - COLUMN_FORCE + which
            return SlipEnd(t + time, advanced_briefly(phase, time, oscillator, p), event)
        t += span
        phase, at_zero = later, -1
    return SlipEnd(stop, phase, NO_EVENT)
