"""Follows a mode of linear slip to its first event, and records it.

A scan with rotation matrices (no trigonometry) finds the interval of the first event, a safeguarded Newton
iteration the event itself, to rounding error. Normal forces are watched only if the amplitudes of the forced
and the free part of the motion allow them to vanish. The oscillator is in ``linear_slip.py``.
"""

from math import inf, pi, sqrt
from typing import Any, NamedTuple

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import guide_friction
from wedgesweep.hybrid.accumulators import add_motion, add_powers
from wedgesweep.hybrid.recorder import first_sample, record_sample
from wedgesweep.hybrid.search import Bracket, Sample, crossing, first_zero, may_graze, searched, zero_near
from wedgesweep.hybrid.state import NO_EVENT, State
from wedgesweep.systems.suspension.energy import supplied_power
from wedgesweep.systems.suspension.events import COLUMN_NORMAL
from wedgesweep.systems.suspension.linear_slip import (
    BOLSTER_FORCE,
    COLUMN_FORCE,
    SLIP,
    LinearOscillator,
    Phase,
    advanced,
    base_acceleration,
    force_at,
    motion,
    phase_at,
    rate_of,
    rotated,
    snap,
    turns,
    value_of,
)
from wedgesweep.systems.suspension.modes import VELOCITY, X

# Scanned intervals per period of input or free vibration, whichever is shorter.
SCAN = 16
# Phase (rad) from which a series of order 3 leads to an event within rounding error.
CONVERGED = 2e-4
# Gauss and Lobatto's rule of five points on [0, 1], by which an interval is recorded. Two neighbours have at
# most one extreme between them, also where a bolster breaks away: its acceleration begins at zero with the
# sign of noise.
PLACES = (0.0, 0.5 - sqrt(3.0 / 28.0), 0.5, 0.5 + sqrt(3.0 / 28.0), 1.0)
WEIGHTS = (1 / 20, 49 / 180, 16 / 45, 49 / 180, 1 / 20)
# Error of the place of an extreme as a share of an interval: the extreme itself has the square of it.
PLACE_OF_EXTREME = 1e-6


class _Event(NamedTuple):
    """How far the slip velocity or a normal force, times a sign, is above a threshold, from a phase on."""

    which: int
    sign: float
    threshold: float
    phase: Phase
    oscillator: LinearOscillator
    p: Any


@inlined
def _above(event, phase):
    now = value_of(event.which, phase, event.oscillator, event.p)
    return Sample(event.sign * now.value - event.threshold, event.sign * now.slope)


@searched(_Event)
@inlined
def _event_at(time, event):
    return _above(event, advanced(event.phase, time, event.oscillator, event.p))


class _Rate(NamedTuple):
    """Rate of a velocity or normal force, times a sign, from a phase on."""

    which: int
    sign: float
    phase: Phase
    oscillator: LinearOscillator
    p: Any


@searched(_Rate)
@inlined
def _rate_at(time, of):
    now = rate_of(of.which, advanced(of.phase, time, of.oscillator, of.p), of.oscillator, of.p)
    return of.sign * now.value, of.sign * now.slope


# Events


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
def _end_of_slip(slip, near):
    """Time at which slip ends, from a time near it, and whether that is within rounding error.

    Newton's method with two more terms of the series for time as a function of velocity.
    """
    oscillator, p = slip.oscillator, slip.p
    phase = advanced(slip.phase, near, oscillator, p)
    now = _above(slip, phase)
    newton = -now.value / now.slope
    second = -0.5 * slip.sign * rate_of(SLIP, phase, oscillator, p).slope / now.slope
    third = 2.0 * second**2 - slip.sign * snap(phase, oscillator, p) / (6.0 * now.slope)
    close = abs(newton) * max(p.input.omega, oscillator.frequency) < CONVERGED and now.slope < 0.0
    return near + newton * (1.0 + newton * (second + newton * third)), close


@inner
def _first_zero(event, before, after, span, at_zero):
    """As ``search.first_zero``."""
    if event.which == SLIP and after.value <= 0.0 < before.value and not at_zero:
        time, close = _end_of_slip(event, crossing(before, after, span))
        if close:
            return time
    return first_zero(event, 0.0, span, before, after, at_zero, 1.0 / event.p.input.omega)


@inlined
def _earlier(found, event, later, span, at_zero):
    """The first event so far, (time, which), or one more if it is earlier; ``at_zero``: it begins at zero."""
    before, after = _above(event, event.phase), _above(event, later)
    if after.value > 0.0 and not may_graze(before, after, span):
        return found
    time = _first_zero(event, before, after, span, at_zero)
    return (time, event.which) if time < found[0] else found


@inlined
def _begins_at(state, oscillator):
    """Event function that is zero where a mode begins; -1 if none is."""
    # Either event of that face may have led to the mode: the one that ends it, or the end of a held jump.
    if state.y[VELOCITY] == 0.0 or state.last_event // 2 == oscillator.event // 2:
        return SLIP
    return state.last_event - COLUMN_NORMAL + COLUMN_FORCE if state.last_event >= COLUMN_NORMAL else -1


@inlined
def follow_linear(state, stop, oscillator, p, keeping, recorder):
    """Follow slip to its first event or ``stop``: the state there, and the event or NO_EVENT."""
    t, mode, at_zero = state.t, state.mode, _begins_at(state, oscillator)
    phase = phase_at(t, state.y, oscillator, p)
    step = 2.0 * pi / max(p.input.omega, oscillator.frequency) / SCAN
    turn = turns(step, oscillator, p)
    forces = at_zero >= COLUMN_FORCE or _forces_may_vanish(phase, oscillator, mode, p)
    event = NO_EVENT
    while t < stop and event == NO_EVENT:
        span = min(step, stop - t)
        later = rotated(phase, *turn) if span == step else advanced(phase, span, oscillator, p)
        slip = _Event(SLIP, mode.column, oscillator.threshold, phase, oscillator, p)
        time, which = _earlier((inf, -1), slip, later, span, at_zero == SLIP)
        if forces:
            column = _Event(COLUMN_FORCE, mode.column_sign, 0.0, phase, oscillator, p)
            bolster = _Event(BOLSTER_FORCE, mode.bolster_sign, 0.0, phase, oscillator, p)
            time, which = _earlier((time, which), column, later, span, at_zero == COLUMN_FORCE)
            time, which = _earlier((time, which), bolster, later, span, at_zero == BOLSTER_FORCE)
        if which >= 0:
            event = oscillator.event if which == SLIP else COLUMN_NORMAL - COLUMN_FORCE + which
            span, later = time, advanced(phase, time, oscillator, p)
        if keeping:
            _record(t, span, phase, oscillator, mode, recorder, p)
        t, phase, at_zero = t + span, later, -1
    t = stop if event == NO_EVENT else t
    return State(t, motion(phase, oscillator, p), mode, state.last_event, state.step), event


# Records


@inlined
def _record_point(phase, weight, oscillator, mode, recorder, p):
    """Add a point to the sums, with its weight (s) in the quadrature."""
    sums, y = recorder.sums[0], motion(phase, oscillator, p)
    add_motion(sums, y, weight, mode, p)
    if recorder.energies:
        g, base = p.geometry, base_acceleration(phase, p)
        column = force_at(oscillator.column, y[X], base)
        bolster = force_at(oscillator.bolster, y[X], base)
        faces = oscillator.column_mu * g.column_ratio * column
        faces += oscillator.bolster_mu * g.bolster_ratio * bolster
        taken = (2.0 * faces - guide_friction.force(y[VELOCITY], mode.guide, p)) * y[VELOCITY]
        # By the mode: a force that is zero at its ends has the sign of rounding errors there.
        pulls = mode.column_sign < 0 or mode.bolster_sign < 0
        add_powers(sums, weight, taken, supplied_power(base, y, p), column, bolster, pulls)


@inlined
def _rates(phase, oscillator, p):
    """Rates of what has extremes."""
    return (
        rate_of(SLIP, phase, oscillator, p).value,
        rate_of(COLUMN_FORCE, phase, oscillator, p).value,
        rate_of(BOLSTER_FORCE, phase, oscillator, p).value,
    )


@inner
def _add_interval(span, phase, oscillator, mode, recorder, p):
    """Add an interval (s) from a phase on to the sums: extremes, and integrals by quadrature."""
    before, last, start = phase, _rates(phase, oscillator, p), 0.0
    for i in range(len(PLACES)):
        here = PLACES[i] * span
        there = advanced(phase, here, oscillator, p)
        now = _rates(there, oscillator, p)
        _record_point(there, WEIGHTS[i] * span, oscillator, mode, recorder, p)
        for which in range(3 if recorder.energies else 1):
            if last[which] * now[which] < 0.0:
                _record_extreme(which, before, here - start, oscillator, mode, recorder, p)
        before, last, start = there, now, here


@inner
def _record(t, span, phase, oscillator, mode, recorder, p):
    """Record an interval (s) from a phase on."""
    if recorder.summed:
        _add_interval(span, phase, oscillator, mode, recorder, p)
    first, turn = first_sample(t, recorder), turns(recorder.step, oscillator, p)
    there = advanced(phase, recorder.start + first * recorder.step - t, oscillator, p)
    for i in range(first, first_sample(t + span, recorder)):
        record_sample(i, motion(there, oscillator, p), mode, recorder, p)
        there = rotated(there, *turn)


@inner
def _record_extreme(which, phase, span, oscillator, mode, recorder, p):
    """Record the extreme of a velocity or normal force whose rate changes its sign in a span of time."""
    sign = 1.0 if rate_of(which, phase, oscillator, p).value > 0.0 else -1.0
    falling = _Rate(which, sign, phase, oscillator, p)
    before, after = Sample(*_rate_at(0.0, falling)), Sample(*_rate_at(span, falling))
    bracket = Bracket(0.0, before.value, span, after.value)
    time = zero_near(falling, bracket, crossing(before, after, span), PLACE_OF_EXTREME * span)
    _record_point(advanced(phase, time, oscillator, p), 0.0, oscillator, mode, recorder, p)
