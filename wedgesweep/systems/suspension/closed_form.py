"""Modes of the base model whose motion has a closed form: slip under constant friction, and sticking.

With constant coefficients of friction the suspension is a linear oscillator:

    x'' = c0 + cx x + cu u''      N = n0 + nx x + nu u''  on either face
    x(t) = centre + forced sin(omega t) + A cos(Omega s) + B sin(Omega s),   s = t - start

A scan with rotation matrices (no trigonometry) finds the interval of the first event, a safeguarded Newton
iteration the event itself, to rounding error. Normal forces are watched only where the amplitudes of both
parts of the motion allow them to vanish. The release from rest is in ``release.py``.
"""

from math import inf, pi, sqrt
from typing import Any, NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import guide_friction
from wedgesweep.hybrid.interface import closed_form, implement
from wedgesweep.hybrid.recorder import (
    NODES,
    WEIGHTS,
    first_sample,
    keep_constant,
    put_known_node,
    put_sample,
)
from wedgesweep.hybrid.search import Bracket, minimum, searched, zero_after_start, zero_near
from wedgesweep.hybrid.state import NO_EVENT
from wedgesweep.systems.suspension.energy import friction_power, supplied_power
from wedgesweep.systems.suspension.events import COLUMN_NORMAL
from wedgesweep.systems.suspension.faces import coefficients
from wedgesweep.systems.suspension.modes import BOLSTER, COLUMN, GUIDE, stuck
from wedgesweep.systems.suspension.newton import Coefficients, Forces, Loads, loads, reactions
from wedgesweep.systems.suspension.release import release
from wedgesweep.trigonometry import cosine, sine, small_turn

# Scanned intervals per period of input or free vibration, whichever is shorter.
SCAN = 16
# Relative distance of both squared frequencies below which the forced and the free part nearly cancel.
RESONANT = 1e-6
# Nodes of the sums: quadrature intervals per period.
INTERVALS = 12.0
# The event functions of an oscillator: slip velocity, and the normal forces on column and bolster.
SLIP, COLUMN_FORCE = 0, 1
# Error of an event's phase (rad), and of that of a minimum as a share of the interval.
ROUNDING, GRAZING = 1e-15, 1e-9


class Oscillator(NamedTuple):
    """One mode's linear equations, solved: see the module's docstring."""

    linear: bool
    frequency: float  # Omega, rad/s
    centre: float  # m
    forced: float  # m
    column: float
    column_x: float
    column_u: float
    bolster: float
    bolster_x: float
    bolster_u: float
    threshold: float  # of |z'|, below which the mode ends
    event: int  # which event function that is


@inlined
def _threshold(mode, p):
    """Smallest |z'| of a mode whose faces all slip, and the event that ends it there."""
    ratio, place, branch = p.geometry.column_ratio, COLUMN, mode.column
    if p.friction.set_valued:
        return 0.0, 2 * COLUMN if branch > 0 else 2 * COLUMN + 1
    v_t, across = p.friction.v_t, abs(p.geometry.bolster_ratio)
    if across != 0.0 and across < ratio:
        ratio, place, branch = across, BOLSTER, mode.bolster
    if guide_friction.acts(p) and ratio > 1.0:
        ratio, place, branch = 1.0, GUIDE, mode.guide
    return v_t / ratio, 2 * place if branch > 0 else 2 * place + 1


@inlined
def _constant_friction(mode, p):
    """Whether no coefficient of friction depends on velocity on this mode."""
    if p.friction.set_valued:
        return True
    bolster = abs(mode.bolster) == 1 or p.geometry.bolster_ratio == 0.0
    guide = abs(mode.guide) == 1 or not guide_friction.acts(p)
    return friction.constant(p) and abs(mode.column) == 1 and bolster and guide


@inner
def oscillator(y, mode, p):
    """Closed form of a mode with constant friction; ``linear`` is False where there is none."""
    if not (p.geometry.always_well_posed and _constant_friction(mode, p)):
        return Oscillator(False, inf, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1)
    s, g, omega = p.suspension, p.geometry, p.input.omega
    column_mu, bolster_mu = coefficients(0.0, y, mode, p)
    mu = Coefficients(mode.column_sign * column_mu, mode.bolster_sign * bolster_mu, 0.0, 0.0)
    at_rest = reactions(loads(0.0, (0.0, 0.0), mode, p), mu, p)[0]
    driven = reactions(Loads(0.0, 0.0, 0.0, 0.0, 0.0, 1.0), mu, p)[0]
    wedge = -s.wedge_spring * g.column_ratio * g.cos_column
    by_x = reactions(
        Loads(wedge * g.cos_column, wedge * g.sin_column, -s.bolster_spring, 0.0, 0.0, 0.0), mu, p
    )[0]
    square = -by_x.acceleration
    linear = square > 0.0 and abs(square - omega**2) > RESONANT * omega**2
    if not linear:
        square = inf
    threshold, event = _threshold(mode, p)
    return Oscillator(
        linear,
        sqrt(square),
        at_rest.acceleration / square,
        driven.acceleration * p.input.amplitude * omega**2 / (omega**2 - square),
        at_rest.column,
        by_x.column,
        driven.column,
        at_rest.bolster,
        by_x.bolster,
        driven.bolster,
        threshold,
        event,
    )


class Phase(NamedTuple):
    """Where the oscillator is: input (cos, sin) and the free part (m) with its quadrature."""

    cosine: float
    sine: float
    free: float
    quadrature: float


@inlined
def _phase(t, x, velocity, free_motion, p):
    """Phase of a state at time t."""
    c, s = cosine(p.input.omega * t), sine(p.input.omega * t)
    free = x - free_motion.centre - free_motion.forced * s
    quadrature = (velocity - free_motion.forced * p.input.omega * c) / free_motion.frequency
    return Phase(c, s, free, quadrature)


@inlined
def _rotated(phase, input_cos, input_sin, free_cos, free_sin):
    """Phase after both parts have turned by the given angles."""
    return Phase(
        phase.cosine * input_cos - phase.sine * input_sin,
        phase.sine * input_cos + phase.cosine * input_sin,
        phase.free * free_cos + phase.quadrature * free_sin,
        phase.quadrature * free_cos - phase.free * free_sin,
    )


@inlined
def _angles(time, o, p):
    """Cosine and sine of the angles by which input and free vibration turn in some time (s)."""
    a, b = p.input.omega * time, o.frequency * time
    return cosine(a), sine(a), cosine(b), sine(b)


@inner
def advanced(phase, time, o, p):
    """Phase some time (s) later."""
    return _rotated(phase, *_angles(time, o, p))


@inlined
def _small_angles(time, o, p):
    """As ``_angles``, for at most an interval of the scan."""
    input_cos, input_sin = small_turn(p.input.omega * time)
    free_cos, free_sin = small_turn(o.frequency * time)
    return input_cos, input_sin, free_cos, free_sin


@inlined
def _soon(phase, time, o, p):
    """As ``advanced``, for at most an interval of the scan."""
    return _rotated(phase, *_small_angles(time, o, p))


@inlined
def motion(phase, o, p):
    """Displacement (m) and velocity (m/s)."""
    x = o.centre + o.forced * phase.sine + phase.free
    return x, o.forced * p.input.omega * phase.cosine + o.frequency * phase.quadrature


@inlined
def _acceleration(phase, o, p):
    """X'' in m/s^2."""
    return -o.forced * p.input.omega**2 * phase.sine - o.frequency**2 * phase.free


class _Sample(NamedTuple):
    """The event functions at a phase, and their time derivatives."""

    values: tuple
    slopes: tuple


@inlined
def _sample(phase, forces, o, mode, p):
    """The event functions at a phase; unless ``forces``, normal forces count as infinite."""
    if forces:
        return _Sample(event_values(phase, o, mode, p), event_slopes(phase, o, mode, p))
    velocity = motion(phase, o, p)[1]
    return _Sample(
        (mode.column * velocity - o.threshold, inf, inf),
        (mode.column * _acceleration(phase, o, p), 0.0, 0.0),
    )


@inlined
def _least(offset, by_x, by_u, amplitude, o, p):
    """Lower bound of a normal force while the mode lasts; ``amplitude`` (m) of the free part."""
    driven = by_x * o.forced - by_u * p.input.amplitude * p.input.omega**2
    return offset + by_x * o.centre - abs(driven) - abs(by_x) * amplitude


@inlined
def _forces_may_vanish(phase, o, mode, p):
    """Whether a normal force may become zero on the mode."""
    amplitude = sqrt(phase.free**2 + phase.quadrature**2)
    a, b = mode.column_sign, mode.bolster_sign
    column = _least(a * o.column, a * o.column_x, a * o.column_u, amplitude, o, p)
    bolster = _least(b * o.bolster, b * o.bolster_x, b * o.bolster_u, amplitude, o, p)
    return min(column, bolster) <= 0.0


@inlined
def event_values(phase, o, mode, p):
    """Event functions of slip velocity and of the normal forces on column and bolster."""
    x, velocity = motion(phase, o, p)
    u2 = -p.input.amplitude * p.input.omega**2 * phase.sine
    return (
        mode.column * velocity - o.threshold,
        mode.column_sign * (o.column + o.column_x * x + o.column_u * u2),
        mode.bolster_sign * (o.bolster + o.bolster_x * x + o.bolster_u * u2),
    )


@inlined
def event_slopes(phase, o, mode, p):
    """Time derivatives of the ``event_values``."""
    velocity = o.forced * p.input.omega * phase.cosine + o.frequency * phase.quadrature
    u3 = -p.input.amplitude * p.input.omega**3 * phase.cosine
    return (
        mode.column * _acceleration(phase, o, p),
        mode.column_sign * (o.column_x * velocity + o.column_u * u3),
        mode.bolster_sign * (o.bolster_x * velocity + o.bolster_u * u3),
    )


class _Piece(NamedTuple):
    """One of the event functions from a phase on."""

    which: int
    phase: Phase
    oscillator: Oscillator
    mode: tuple
    p: Any


@searched(_Piece)
@inlined
def _value(time, piece):
    """An event function some time (s) after the phase of a piece."""
    which, phase, o, mode, p = piece
    there = _soon(phase, time, o, p)
    return event_values(there, o, mode, p)[which], event_slopes(there, o, mode, p)[which]


@inlined
def _may_graze(which, before, after, span):
    """Whether an event function may be negative between two positive samples.

    It may if its tangents meet near zero or below: between samples this close a function with a minimum is
    convex, and lies above its tangents.
    """
    now, falling = before.values[which], before.slopes[which]
    following, rising = after.values[which], after.slopes[which]
    if not falling < 0.0 < rising:
        return False
    lowest = (rising * now - falling * following + falling * rising * span) / (rising - falling)
    return lowest < 0.1 * now


@inlined
def _crossing(which, before, after, span):
    """Estimate of the time at which an event function that falls over an interval is zero.

    Hermite's cubic for time as a function of the value; between samples this close it is good to 1e-4.
    """
    rise, start, end = after.values[which] - before.values[which], before.slopes[which], after.slopes[which]
    share = -before.values[which] / rise
    if not (start < 0.0 and end < 0.0):
        return share * span
    rest = 1.0 - share
    return share * (share * (3.0 - 2.0 * share) * span + rest * rise * (rest / start - share / end))


@inner
def _first_event(phase, o, mode, span, samples, at_zero, p):
    """Time and number of the first event within a span between two samples; inf where there is none."""
    before, after = samples
    earliest, first = inf, -1
    close, nearest = ROUNDING / p.input.omega, 1e-12 / p.input.omega
    for which in range(3):
        piece, high, value = _Piece(which, phase, o, mode, p), span, after.values[which]
        if value > 0.0 and which != at_zero and _may_graze(which, before, after, span):
            high = minimum(piece, 0.0, span, GRAZING * span)
            value = _value(high, piece)[0]
        if value > 0.0:
            continue
        bracket = Bracket(0.0, before.values[which], high, value)
        if which == at_zero or bracket.at_low <= 0.0:
            time = zero_after_start(piece, bracket, nearest, close)
        else:
            time = zero_near(piece, bracket, _crossing(which, before, after, span), close)
        if time < earliest:
            earliest, first = time, which
    return earliest, first


@inlined
def _any_event(before, after, span):
    """Whether ``_first_event`` has anything to look for."""
    found = min(after.values[0], after.values[1], after.values[2]) <= 0.0
    for which in range(3):
        found = found or _may_graze(which, before, after, span)
    return found


@inner
def slide(state, stop, o, p):
    """Follow slip to its first event or ``stop``: time, displacement, velocity, and the event or NO_EVENT."""
    t, (x, velocity), mode, last_event, _ = state
    step = 2.0 * pi / max(p.input.omega, o.frequency) / SCAN
    turn = _small_angles(step, o, p)
    at_zero = last_event - COLUMN_NORMAL + COLUMN_FORCE if last_event >= COLUMN_NORMAL else -1
    if velocity == 0.0 or last_event == o.event:
        at_zero = SLIP
    phase = _phase(t, x, velocity, o, p)
    forces = at_zero >= COLUMN_FORCE or _forces_may_vanish(phase, o, mode, p)
    now = _sample(phase, forces, o, mode, p)
    while t < stop:
        span = min(step, stop - t)
        later = _rotated(phase, *turn) if span == step else _soon(phase, span, o, p)
        following = _sample(later, forces, o, mode, p)
        if _any_event(now, following, span):
            found, which = _first_event(phase, o, mode, span, (now, following), at_zero, p)
            if which >= 0:
                x, velocity = motion(_soon(phase, found, o, p), o, p)
                return t + found, x, velocity, o.event if which == SLIP else COLUMN_NORMAL - 1 + which
        t += span
        phase, now = later, following
        at_zero = -1
    x, velocity = motion(phase, o, p)
    return stop, x, velocity, NO_EVENT


@inner
def _fastest(phase, low, high, rate, following, o, p):
    """Time of the extreme velocity between two times (s after the phase) with accelerations of opposite sign.

    The velocity there is off by the square of the error in time only: few iterations do.
    """
    time = low + (high - low) * rate / (rate - following)
    for _ in range(3):
        there = advanced(phase, time, o, p)
        jerk = -o.forced * p.input.omega**3 * there.cosine - o.frequency**3 * there.quadrature
        if jerk != 0.0:
            time = min(max(time - _acceleration(there, o, p) / jerk, low), high)
    return time


@inner
def _put_node(phase, weight, mode, o, recorder, p):
    """Add a node to the sums, with the forces that the closed form knows."""
    y = motion(phase, o, p)
    base = -p.input.amplitude * p.input.omega**2 * phase.sine
    column = o.column + o.column_x * y[0] + o.column_u * base
    bolster = o.bolster + o.bolster_x * y[0] + o.bolster_u * base
    taken = friction_power(0.0, y, mode, Forces(0.0, 0.0, 0.0, column, bolster), p)
    powers = (taken, supplied_power(base, y, p), column, bolster)
    put_known_node(powers, y, weight, mode, recorder, p)


@inner
def _keep_nodes(state, end, o, recorder, p):
    """Add the nodes of a piece to the sums, its ends, and where the velocity is extreme."""
    t, (x, velocity), mode, _, _ = state
    start = _phase(t, x, velocity, o, p)
    _put_node(start, 0.0, mode, o, recorder, p)
    earlier, rate = 0.0, _acceleration(start, o, p)
    parts = int((end - t) * max(p.input.omega, o.frequency) / (2.0 * pi) * INTERVALS) + 1
    span = (end - t) / parts
    turn = _angles(span, o, p)
    turns = (
        _angles(span * NODES[0], o, p),
        _angles(span * NODES[1], o, p),
        _angles(span * NODES[2], o, p),
        _angles(span * NODES[3], o, p),
    )
    phase = start
    for i in range(parts * len(NODES) + 1):
        part, node = i // len(NODES), i % len(NODES)
        if i > 0 and node == 0:
            phase = _rotated(phase, *turn)
        there, time, weight = phase, span * part, 0.0
        if part < parts:
            there = _rotated(phase, *turns[node])
            time, weight = span * (part + NODES[node]), span * WEIGHTS[node]
        now = _acceleration(there, o, p)
        if rate * now < 0.0:
            fastest = _fastest(start, earlier, time, rate, now, o, p)
            _put_node(advanced(start, fastest, o, p), 0.0, mode, o, recorder, p)
        _put_node(there, weight, mode, o, recorder, p)
        earlier, rate = time, now


@inner
def keep(state, end, o, recorder, p):
    """Keep a piece that ``slide`` has followed from a state to ``end``."""
    _keep_nodes(state, end, o, recorder, p)
    t, (x, velocity), mode, _, _ = state
    first = first_sample(t, recorder)
    there = advanced(_phase(t, x, velocity, o, p), recorder.start + first * recorder.step - t, o, p)
    turn = _angles(recorder.step, o, p)
    for i in range(first, first_sample(end, recorder)):
        put_sample(i, motion(there, o, p), mode, recorder, p)
        there = _rotated(there, *turn)


@implement(closed_form, "base")
@inner
def follow(state, stop, p, keeping, recorder):
    """Follow a mode to its event or ``stop`` if it has a closed form."""
    if stuck(state.mode, p):
        end, event = release(state, stop, p)
        if keeping:
            keep_constant(state.t, end, state.y, state.mode, recorder, p)
        return True, end, state.y, event
    o = oscillator(state.y, state.mode, p)
    if not o.linear:
        return False, state.t, state.y, NO_EVENT
    end, x, velocity, event = slide(state, stop, o, p)
    if keeping:
        keep(state, end, o, recorder, p)
    return True, end, (x, velocity), event


@implement(closed_form, "suspension")
@inlined
def no_closed_form(state, stop, p, keeping, recorder):
    """No closed form: effects with their own mechanics are integrated."""
    return False, state.t, state.y, NO_EVENT
