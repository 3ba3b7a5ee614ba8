"""What a mode of linear slip adds to the sums and samples of a kept window.

While the mode holds, velocity and normal forces keep their signs, and all integrals have a closed form. With
theta the phase of the input, f and q the free part and its quadrature,

    W = int sin(theta) q dt = [omega cos(theta) q + Omega sin(theta) f] / (Omega^2 - omega^2)
    int sin(theta) x' dt = [forced sin^2(theta) / 2] + Omega W
    int N x' dt = [n0 x + nx x^2 / 2] - nu a omega^2 int sin(theta) x' dt

where brackets stand for differences between the end and the start of the mode. Extremes are there, and where
a rate is zero.
"""

from math import pi
from typing import Any, NamedTuple

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import guide_friction
from wedgesweep.hybrid.accumulators import Span, add_extremes, add_span
from wedgesweep.hybrid.recorder import first_sample, record_sample
from wedgesweep.hybrid.search import Bracket, Sample, crossing, searched, zero_near
from wedgesweep.systems.suspension.energy import supplied_power
from wedgesweep.systems.suspension.linear_slip import (
    LinearOscillator,
    Phase,
    acceleration,
    advanced,
    advanced_briefly,
    angles,
    base_acceleration,
    force_at,
    force_rate,
    jerk,
    motion,
    rotated,
    small_angles,
)

# Scanned intervals per period, in each of which a rate changes its sign at most once; error of the place of
# an extreme as a share of an interval: the extreme itself has the square of it.
INTERVALS, PLACE_OF_EXTREME = 13.0, 1e-6
LEAST_PARTS = 3
# What has extremes.
VELOCITY, COLUMN, BOLSTER = 0, 1, 2


class _Rate(NamedTuple):
    """Rate of a velocity or normal force from a phase on, times a sign."""

    which: int
    sign: float
    phase: Phase
    oscillator: LinearOscillator
    p: Any


@inlined
def _rate(which, phase, oscillator, p):
    """A rate and its slope."""
    if which == VELOCITY:
        return Sample(acceleration(phase, oscillator, p), jerk(phase, oscillator, p))
    return force_rate(oscillator.column if which == COLUMN else oscillator.bolster, phase, oscillator, p)


@inlined
def _rates(phase, oscillator, p):
    return (
        _rate(VELOCITY, phase, oscillator, p),
        _rate(COLUMN, phase, oscillator, p),
        _rate(BOLSTER, phase, oscillator, p),
    )


@searched(_Rate)
@inlined
def _signed(time, rate):
    there = advanced_briefly(rate.phase, time, rate.oscillator, rate.p)
    value, slope = _rate(rate.which, there, rate.oscillator, rate.p)
    return rate.sign * value, rate.sign * slope


@inlined
def _add_point(phase, oscillator, recorder, p):
    """Add what may be an extreme."""
    x, velocity = motion(phase, oscillator, p)
    base = base_acceleration(phase, p)
    normal = force_at(oscillator.column, x, base), force_at(oscillator.bolster, x, base)
    add_extremes(recorder.sums[0], x, velocity, normal, recorder.energies)


@inner
def _add_extreme(rate, before, after, span, recorder):
    """Add the extreme of a velocity or normal force whose rate changes its sign in a span of time."""
    bracket = Bracket(0.0, abs(before.value), span, -abs(after.value))
    time = zero_near(rate, bracket, crossing(before, after, span), PLACE_OF_EXTREME * span)
    _add_point(advanced_briefly(rate.phase, time, rate.oscillator, rate.p), rate.oscillator, recorder, rate.p)


@inlined
def _add_extremes(phase, duration, oscillator, recorder, p):
    """Add both ends of a mode and all extremes in between; the phase at its end."""
    parts = int(duration * max(p.input.omega, oscillator.frequency) / (2.0 * pi) * INTERVALS) + 1
    # A bolster breaks away at a rate of zero, whose sign is noise; a short slip peaks after a third of it.
    parts = max(parts, LEAST_PARTS)
    span = duration / parts
    turn = small_angles(span, oscillator, p)
    _add_point(phase, oscillator, recorder, p)
    before = _rates(phase, oscillator, p)
    for _ in range(parts):
        later = rotated(phase, *turn)
        after = _rates(later, oscillator, p)
        for which in range(3 if recorder.energies else 1):
            if before[which].value * after[which].value < 0.0:
                rate = _Rate(which, 1.0 if before[which].value > 0.0 else -1.0, phase, oscillator, p)
                _add_extreme(rate, before[which], after[which], span, recorder)
        phase, before = later, after
    _add_point(phase, oscillator, recorder, p)
    return phase


@inlined
def _integrated(force, one, x, base):
    """Integral of a normal force over x (J) or time (N s), from those of 1, x and u''."""
    return force.at_rest * one + force.by_x * x + force.by_u * base


@inlined
def _work(start, end, oscillator, mode, p):
    """Work (J) that friction takes and that the base supplies between two phases of a mode."""
    g, omega, frequency = p.geometry, p.input.omega, oscillator.frequency
    x, later = motion(start, oscillator, p)[0], motion(end, oscillator, p)[0]
    travelled, square = later - x, 0.5 * (later - x) * (later + x)
    of_free = end.sine * end.free - start.sine * start.free
    of_quadrature = end.cosine * end.quadrature - start.cosine * start.quadrature
    free = (omega * of_quadrature + frequency * of_free) / (frequency**2 - omega**2)
    sine = 0.5 * oscillator.forced * (end.sine**2 - start.sine**2) + frequency * free
    base = -p.input.amplitude * omega**2 * sine
    column = _integrated(oscillator.column, travelled, square, base)
    bolster = _integrated(oscillator.bolster, travelled, square, base)
    faces = oscillator.column_mu * g.column_ratio * column + oscillator.bolster_mu * g.bolster_ratio * bolster
    taken = 2.0 * faces - guide_friction.force(motion(start, oscillator, p)[1], mode.guide, p) * travelled
    return taken, supplied_power(base, (0.0, 1.0), p)


@inlined
def _add_integrals(start, end, duration, oscillator, mode, recorder, p):
    """Add the integrals between two phases of a mode."""
    of_sine = oscillator.forced * (start.cosine - end.cosine) / p.input.omega
    integral = (
        oscillator.centre * duration + of_sine + (start.quadrature - end.quadrature) / oscillator.frequency
    )
    dissipated, supplied = _work(start, end, oscillator, mode, p)
    lifted = mode.column_sign < 0 or mode.bolster_sign < 0
    base = p.input.amplitude * p.input.omega * (end.cosine - start.cosine)
    column = _integrated(oscillator.column, duration, integral, base)
    bolster = _integrated(oscillator.bolster, duration, integral, base)
    span = Span(duration, integral, False, lifted, dissipated, supplied, column, bolster)
    add_span(recorder.sums[0], span)


@inner
def record_slip(state, start, end, oscillator, recorder, p):
    """Record what ``slip_to_event`` has followed: from a state, whose phase is ``start``, to ``end`` (s)."""
    t, mode = state.t, state.mode
    if end > t:
        last = _add_extremes(start, end - t, oscillator, recorder, p)
        _add_integrals(start, last, end - t, oscillator, mode, recorder, p)
    first = first_sample(t, recorder)
    there = advanced(start, recorder.start + first * recorder.step - t, oscillator, p)
    turn = angles(recorder.step, oscillator, p)
    for i in range(first, first_sample(end, recorder)):
        record_sample(i, motion(there, oscillator, p), mode, recorder, p)
        there = rotated(there, *turn)
