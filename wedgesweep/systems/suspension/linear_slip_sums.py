"""What a mode of linear slip adds to the sums and samples of a kept window.

While the mode holds, velocity and normal forces keep their signs, and all integrals have a closed form. With
theta the phase of the input, f and q the free part and its quadrature,

    W = int sin(theta) q dt = [omega cos(theta) q + Omega sin(theta) f] / (Omega^2 - omega^2)
    int sin(theta) x' dt = [forced sin^2(theta) / 2] + Omega W
    int N x' dt = [n0 x + nx x^2 / 2] - nu a omega^2 int sin(theta) x' dt

where brackets stand for differences between the end and the start of the mode. Extremes are there, and where
a rate is zero.
"""

from math import nan, pi
from typing import Any, NamedTuple

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import guide_friction
from wedgesweep.hybrid.accumulators import Span, add_extremes, add_span
from wedgesweep.hybrid.recorder import first_sample, record_sample
from wedgesweep.hybrid.search import Bracket, searched, zero
from wedgesweep.systems.suspension.energy import supplied_power
from wedgesweep.systems.suspension.linear_slip import (
    Oscillator,
    Phase,
    acceleration,
    advanced,
    advanced_briefly,
    angles,
    force_rates,
    motion,
    normal_forces,
    phase_at,
    rotated,
    small_angles,
)

# Scanned intervals per period, in each of which a rate changes its sign at most once; error of the place of
# an extreme as a share of an interval: the extreme itself has the square of it.
INTERVALS, CLOSE = 13.0, 1e-6
LEAST_PARTS = 3
# What has extremes.
VELOCITY, COLUMN, BOLSTER = 0, 1, 2


class _Rate(NamedTuple):
    """Rate of a velocity or normal force from a phase on, times a sign."""

    which: int
    sign: float
    phase: Phase
    oscillator: Oscillator
    p: Any


@inlined
def _rate(which, phase, o, p):
    if which == VELOCITY:
        return acceleration(phase, o, p)
    return force_rates(phase, o, p)[which - COLUMN]


@searched(_Rate)
@inner
def _signed(time, rate):
    there = advanced_briefly(rate.phase, time, rate.oscillator, rate.p)
    return rate.sign * _rate(rate.which, there, rate.oscillator, rate.p), nan


@inner
def _put_point(phase, o, recorder, p):
    """Add what may be an extreme."""
    x, velocity = motion(phase, o, p)
    column, bolster = normal_forces(phase, o, p)
    add_extremes(recorder.sums[0], x, velocity, min(column, bolster), recorder.energies)


@inner
def _put_turning(which, phase, later, span, o, recorder, p):
    """Add the extreme of a velocity or normal force between two phases, if there is one."""
    before, after = _rate(which, phase, o, p), _rate(which, later, o, p)
    if before * after < 0.0:
        rate = _Rate(which, 1.0 if before > 0.0 else -1.0, phase, o, p)
        time = zero(rate, Bracket(0.0, abs(before), span, -abs(after)), CLOSE * span)
        _put_point(advanced_briefly(phase, time, o, p), o, recorder, p)


@inner
def _put_extremes(phase, duration, o, recorder, p):
    """Add both ends of a mode and all extremes in between; the phase at its end."""
    parts = int(duration * max(p.input.omega, o.frequency) / (2.0 * pi) * INTERVALS) + 1
    # A bolster breaks away at a rate of zero, whose sign is noise; a short slip peaks after a third of it.
    parts = max(parts, LEAST_PARTS)
    span = duration / parts
    turn = small_angles(span, o, p)
    _put_point(phase, o, recorder, p)
    for _ in range(parts):
        later = rotated(phase, *turn)
        _put_turning(VELOCITY, phase, later, span, o, recorder, p)
        if recorder.energies:
            _put_turning(COLUMN, phase, later, span, o, recorder, p)
            _put_turning(BOLSTER, phase, later, span, o, recorder, p)
        phase = later
    _put_point(phase, o, recorder, p)
    return phase


@inlined
def _work(start, end, o, mode, p):
    """Work (J) that friction takes and that the base supplies between two phases of a mode."""
    g, omega, frequency = p.geometry, p.input.omega, o.frequency
    x, later = motion(start, o, p)[0], motion(end, o, p)[0]
    travelled, square = later - x, 0.5 * (later - x) * (later + x)
    of_free = end.sine * end.free - start.sine * start.free
    of_quadrature = end.cosine * end.quadrature - start.cosine * start.quadrature
    free = (omega * of_quadrature + frequency * of_free) / (frequency**2 - omega**2)
    sine = 0.5 * o.forced * (end.sine**2 - start.sine**2) + frequency * free
    base = -p.input.amplitude * omega**2 * sine
    column = o.column * travelled + o.column_x * square + o.column_u * base
    bolster = o.bolster * travelled + o.bolster_x * square + o.bolster_u * base
    faces = o.column_mu * g.column_ratio * column + o.bolster_mu * g.bolster_ratio * bolster
    taken = 2.0 * faces - guide_friction.force(motion(start, o, p)[1], mode.guide, p) * travelled
    return taken, supplied_power(base, (0.0, 1.0), p)


@inner
def _put_span(start, end, duration, o, mode, recorder, p):
    """Add the integrals between two phases of a mode."""
    of_sine = o.forced * (start.cosine - end.cosine) / p.input.omega
    integral = o.centre * duration + of_sine + (start.quadrature - end.quadrature) / o.frequency
    dissipated, supplied = _work(start, end, o, mode, p)
    lifted = mode.column_sign < 0 or mode.bolster_sign < 0
    add_span(recorder.sums[0], Span(duration, integral, False, lifted, dissipated, supplied))


@inner
def record_slip(state, end, o, recorder, p):
    """Record what ``slip_to_event`` has followed, from a state to the time ``end`` (s)."""
    t, (x, velocity), mode, _, _ = state
    start = phase_at(t, x, velocity, o, p)
    if end > t:
        last = _put_extremes(start, end - t, o, recorder, p)
        _put_span(start, last, end - t, o, mode, recorder, p)
    first = first_sample(t, recorder)
    there = advanced(start, recorder.start + first * recorder.step - t, o, p)
    turn = angles(recorder.step, o, p)
    for i in range(first, first_sample(end, recorder)):
        record_sample(i, motion(there, o, p), mode, recorder, p)
        there = rotated(there, *turn)
