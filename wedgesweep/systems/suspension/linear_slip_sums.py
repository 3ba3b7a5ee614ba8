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
    LinearOscillator,
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
    if which == VELOCITY:
        return acceleration(phase, oscillator, p)
    return force_rates(phase, oscillator, p)[which - COLUMN]


@searched(_Rate)
@inner
def _signed(time, rate):
    there = advanced_briefly(rate.phase, time, rate.oscillator, rate.p)
    return rate.sign * _rate(rate.which, there, rate.oscillator, rate.p), nan


@inner
def _add_point(phase, oscillator, recorder, p):
    """Add what may be an extreme."""
    x, velocity = motion(phase, oscillator, p)
    column, bolster = normal_forces(phase, oscillator, p)
    add_extremes(recorder.sums[0], x, velocity, min(column, bolster), recorder.energies)


@inner
def _add_extreme(which, phase, later, span, oscillator, recorder, p):
    """Add the extreme of a velocity or normal force between two phases, if there is one."""
    before, after = _rate(which, phase, oscillator, p), _rate(which, later, oscillator, p)
    if before * after < 0.0:
        rate = _Rate(which, 1.0 if before > 0.0 else -1.0, phase, oscillator, p)
        time = zero(rate, Bracket(0.0, abs(before), span, -abs(after)), PLACE_OF_EXTREME * span)
        _add_point(advanced_briefly(phase, time, oscillator, p), oscillator, recorder, p)


@inner
def _add_extremes(phase, duration, oscillator, recorder, p):
    """Add both ends of a mode and all extremes in between; the phase at its end."""
    parts = int(duration * max(p.input.omega, oscillator.frequency) / (2.0 * pi) * INTERVALS) + 1
    # A bolster breaks away at a rate of zero, whose sign is noise; a short slip peaks after a third of it.
    parts = max(parts, LEAST_PARTS)
    span = duration / parts
    turn = small_angles(span, oscillator, p)
    _add_point(phase, oscillator, recorder, p)
    for _ in range(parts):
        later = rotated(phase, *turn)
        _add_extreme(VELOCITY, phase, later, span, oscillator, recorder, p)
        if recorder.energies:
            _add_extreme(COLUMN, phase, later, span, oscillator, recorder, p)
            _add_extreme(BOLSTER, phase, later, span, oscillator, recorder, p)
        phase = later
    _add_point(phase, oscillator, recorder, p)
    return phase


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
    column = oscillator.column * travelled + oscillator.column_x * square + oscillator.column_u * base
    bolster = oscillator.bolster * travelled + oscillator.bolster_x * square + oscillator.bolster_u * base
    faces = oscillator.column_mu * g.column_ratio * column + oscillator.bolster_mu * g.bolster_ratio * bolster
    taken = 2.0 * faces - guide_friction.force(motion(start, oscillator, p)[1], mode.guide, p) * travelled
    return taken, supplied_power(base, (0.0, 1.0), p)


@inner
def _add_integrals(start, end, duration, oscillator, mode, recorder, p):
    """Add the integrals between two phases of a mode."""
    of_sine = oscillator.forced * (start.cosine - end.cosine) / p.input.omega
    integral = (
        oscillator.centre * duration + of_sine + (start.quadrature - end.quadrature) / oscillator.frequency
    )
    dissipated, supplied = _work(start, end, oscillator, mode, p)
    lifted = mode.column_sign < 0 or mode.bolster_sign < 0
    add_span(recorder.sums[0], Span(duration, integral, False, lifted, dissipated, supplied))


@inner
def record_slip(state, end, oscillator, recorder, p):
    """Record what ``slip_to_event`` has followed, from a state to the time ``end`` (s)."""
    t, (x, velocity), mode, _, _ = state
    start = phase_at(t, x, velocity, oscillator, p)
    if end > t:
        last = _add_extremes(start, end - t, oscillator, recorder, p)
        _add_integrals(start, last, end - t, oscillator, mode, recorder, p)
    first = first_sample(t, recorder)
    there = advanced(start, recorder.start + first * recorder.step - t, oscillator, p)
    turn = angles(recorder.step, oscillator, p)
    for i in range(first, first_sample(end, recorder)):
        record_sample(i, motion(there, oscillator, p), mode, recorder, p)
        there = rotated(there, *turn)
