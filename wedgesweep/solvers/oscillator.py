"""Slip in closed form: with constant friction coefficients the suspension is a linear oscillator.

    x'' = c0 + cx x + cu u''      N = n0 + nx x + nu u''  on either face
    x(t) = centre + forced sin(omega t) + A cos(Omega s) + B sin(Omega s),   s = t - start

A scan with rotation matrices (no trigonometry) finds the interval of the first switch, a safeguarded
Newton iteration the switch itself, to rounding error.
"""

from math import cos, inf, pi, sin, sqrt
from typing import NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import compiled, inlined
from wedgesweep.contact import BOLSTER, COLUMN, COLUMN_NORMAL, GUIDE
from wedgesweep.damper import forces, spring_response
from wedgesweep.solvers.recorder import NODES, WEIGHTS, first_sample, put_node, put_sample

# Scanned intervals per period of input or free vibration, whichever is shorter.
SCAN = 16
# Closer to the input frequency than this the forced and the free part nearly cancel.
RESONANT = 1e-6
VELOCITY = 0


class Oscillator(NamedTuple):
    """One contact's linear equations, solved: see the module's docstring."""

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
    threshold: float  # of |z'|, below which the contact ends
    switch: int  # which place in contact.switches that is


@compiled
def _threshold(contact, p):
    """Smallest |z'| of a contact whose faces all slip, and the switch that ends it there."""
    if p.set_valued:
        return 0.0, COLUMN if contact.column > 0 else COLUMN + 1
    threshold = p.threshold_velocity / p.column_ratio
    switch = COLUMN if contact.column > 0 else COLUMN + 1
    if p.bolster_ratio != 0.0 and p.threshold_velocity / abs(p.bolster_ratio) > threshold:
        threshold = p.threshold_velocity / abs(p.bolster_ratio)
        switch = BOLSTER if contact.bolster > 0 else BOLSTER + 1
    if p.guide_friction_force > 0.0 and p.threshold_velocity > threshold:
        threshold = p.threshold_velocity
        switch = GUIDE if contact.guide > 0 else GUIDE + 1
    return threshold, switch


@compiled
def constant_friction(contact, p):
    """Whether no coefficient of friction depends on velocity on this contact."""
    if p.law == 0:
        return True
    bolster = abs(contact.bolster) == 1 or p.bolster_ratio == 0.0
    guide = abs(contact.guide) == 1 or p.guide_friction_force == 0.0
    return p.law == 1 and abs(contact.column) == 1 and bolster and guide


@compiled
def oscillator(contact, p):
    """Closed form of a contact with constant friction; ``linear`` is False where there is none."""
    if not (p.never_locks and constant_friction(contact, p)):
        return Oscillator(False, inf, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1)
    at_rest = forces(0.0, 0.0, 0.0, contact, p)
    driven = forces(0.0, 0.0, 1.0, contact, p)
    column_mu = contact.column_sign * friction.coefficient(0.0, contact.column, p)
    bolster_mu = contact.bolster_sign * friction.coefficient(0.0, contact.bolster, p)
    by_x = spring_response(column_mu, bolster_mu, p)
    square = -by_x.acceleration
    linear = square > 0.0 and abs(square - p.omega**2) > RESONANT * p.omega**2
    if not linear:
        square = inf
    by_u = driven.acceleration - at_rest.acceleration
    threshold, switch = _threshold(contact, p)
    return Oscillator(
        linear,
        sqrt(square),
        at_rest.acceleration / square,
        by_u * p.amplitude * p.omega**2 / (p.omega**2 - square),
        at_rest.column,
        by_x.column,
        driven.column - at_rest.column,
        at_rest.bolster,
        by_x.bolster,
        driven.bolster - at_rest.bolster,
        threshold,
        switch,
    )


class Phase(NamedTuple):
    """Where the oscillator is: input (cos, sin) and the free part (m) with its quadrature."""

    cosine: float
    sine: float
    free: float
    quadrature: float


@compiled
def phase_of(t, x, velocity, o, p):
    """Phase of a state at time t."""
    c, s = cos(p.omega * t), sin(p.omega * t)
    free = x - o.centre - o.forced * s
    quadrature = (velocity - o.forced * p.omega * c) / o.frequency
    return Phase(c, s, free, quadrature)


@inlined
def turned(f, input_cos, input_sin, free_cos, free_sin):
    """Phase after both parts have turned by the given angles."""
    return Phase(
        f.cosine * input_cos - f.sine * input_sin,
        f.sine * input_cos + f.cosine * input_sin,
        f.free * free_cos + f.quadrature * free_sin,
        f.quadrature * free_cos - f.free * free_sin,
    )


@compiled
def after(f, time, o, p):
    """Phase some time (s) later."""
    a, b = p.omega * time, o.frequency * time
    return turned(f, cos(a), sin(a), cos(b), sin(b))


@inlined
def state(f, o, p):
    """Deflection (m) and velocity (m/s)."""
    x = o.centre + o.forced * f.sine + f.free
    return x, o.forced * p.omega * f.cosine + o.frequency * f.quadrature


@compiled
def acceleration(f, o, p):
    """X'' in m/s^2."""
    return -o.forced * p.omega**2 * f.sine - o.frequency**2 * f.free


@compiled
def margins(f, o, contact, p):
    """Switching functions of slip velocity and of the normal forces on column and bolster."""
    x, velocity = state(f, o, p)
    u2 = -p.amplitude * p.omega**2 * f.sine
    return (
        contact.column * velocity - o.threshold,
        contact.column_sign * (o.column + o.column_x * x + o.column_u * u2),
        contact.bolster_sign * (o.bolster + o.bolster_x * x + o.bolster_u * u2),
    )


@compiled
def slopes(f, o, contact, p):
    """Time derivatives of the ``margins``."""
    velocity = o.forced * p.omega * f.cosine + o.frequency * f.quadrature
    u3 = -p.amplitude * p.omega**3 * f.cosine
    return (
        contact.column * acceleration(f, o, p),
        contact.column_sign * (o.column_x * velocity + o.column_u * u3),
        contact.bolster_sign * (o.bolster_x * velocity + o.bolster_u * u3),
    )


@compiled
def margin_and_slope(which, f, o, contact, p):
    """One of the ``margins`` and its time derivative."""
    if which == VELOCITY:
        velocity = o.forced * p.omega * f.cosine + o.frequency * f.quadrature
        return contact.column * velocity - o.threshold, contact.column * acceleration(f, o, p)
    x, velocity = state(f, o, p)
    u2 = -p.amplitude * p.omega**2 * f.sine
    u3 = -p.amplitude * p.omega**3 * f.cosine
    if which == 1:
        sign, at_rest, by_x, by_u = contact.column_sign, o.column, o.column_x, o.column_u
    else:
        sign, at_rest, by_x, by_u = contact.bolster_sign, o.bolster, o.bolster_x, o.bolster_u
    return sign * (at_rest + by_x * x + by_u * u2), sign * (by_x * velocity + by_u * u3)


@compiled
def _zero(which, f, low, high, guess, o, contact, p):
    """Zero of a margin that is positive at ``low`` and not at ``high`` (s after f)."""
    time = guess if low < guess < high else 0.5 * (low + high)
    for _ in range(60):
        value, slope = margin_and_slope(which, after(f, time, o, p), o, contact, p)
        if value > 0.0:
            low = time
        else:
            high = time
        newton = time - value / slope if slope != 0.0 else low
        if abs(newton - time) * p.omega <= 1e-15:
            return newton
        time = newton if low < newton < high else 0.5 * (low + high)
    return time


@compiled
def _dip(which, f, span, o, contact, p):
    """Time of the minimum of a margin whose slope is negative at first and positive after ``span``."""
    low, high = 0.0, span
    for _ in range(50):
        middle = 0.5 * (low + high)
        if margin_and_slope(which, after(f, middle, o, p), o, contact, p)[1] < 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@compiled
def _crossing(which, f, span, before, now, at_zero, o, contact, p):
    """Time of the first zero of a margin that is not positive after ``span``."""
    low = 0.0
    if at_zero or before <= 0.0:
        # The span starts on the switch itself: find a place behind it where the margin is positive.
        low = 0.5 * span
        while margin_and_slope(which, after(f, low, o, p), o, contact, p)[0] <= 0.0:
            span = low
            low *= 0.5
            if low * p.omega < 1e-12:
                return 0.0
    return _zero(which, f, low, span, span * before / (before - now), o, contact, p)


@compiled
def _may_dip(now, falling, following, rising, span):
    """Whether a margin may be negative between two positive samples: their tangents meet near zero or below.

    Between samples so close a margin with a minimum is convex, so that it lies above its tangents.
    """
    if not falling < 0.0 < rising:
        return False
    lowest = (rising * now - falling * following + falling * rising * span) / (rising - falling)
    return lowest < 0.1 * now


@compiled
def _first(f, span, before, now, at_zero, o, contact, p):
    """Time and number of the first margin to vanish within a span; inf where none does."""
    earliest, which = inf, -1
    for i in range(3):
        if now[i] <= 0.0:
            crossing = _crossing(i, f, span, before[i], now[i], at_zero == i, o, contact, p)
            if crossing < earliest:
                earliest, which = crossing, i
    return earliest, which


@compiled
def slide(t, stop, x, velocity, contact, o, p, last_switch):
    """Follow slip until its first switch or ``stop``: time, x, velocity and the switch (-1: none)."""
    step = 2.0 * pi / max(p.omega, o.frequency) / SCAN
    a, b = p.omega * step, o.frequency * step
    turn_a, turn_b, turn_c, turn_d = cos(a), sin(a), cos(b), sin(b)
    at_zero = last_switch - COLUMN_NORMAL + 1 if last_switch >= COLUMN_NORMAL else -1
    if velocity == 0.0 or last_switch == o.switch:
        at_zero = VELOCITY
    f = phase_of(t, x, velocity, o, p)
    now, falling = margins(f, o, contact, p), slopes(f, o, contact, p)
    while t < stop:
        span = min(step, stop - t)
        g = turned(f, turn_a, turn_b, turn_c, turn_d) if span == step else after(f, span, o, p)
        following, rising = margins(g, o, contact, p), slopes(g, o, contact, p)
        found, which = inf, -1
        if min(following[0], following[1], following[2]) <= 0.0:
            found, which = _first(f, span, now, following, at_zero, o, contact, p)
        for i in range(3):
            may_dip = _may_dip(now[i], falling[i], following[i], rising[i], span)
            if may_dip and following[i] > 0.0 and i != at_zero:
                dip = _dip(i, f, span, o, contact, p)
                low = margin_and_slope(i, after(f, dip, o, p), o, contact, p)[0]
                if low <= 0.0:
                    zero = _crossing(i, f, dip, now[i], low, False, o, contact, p)
                    if zero < found:
                        found, which = zero, i
        if which >= 0:
            x, velocity = state(after(f, found, o, p), o, p)
            return t + found, x, velocity, o.switch if which == 0 else COLUMN_NORMAL - 1 + which
        t += span
        f, now, falling = g, following, rising
        at_zero = -1
    x, velocity = state(f, o, p)
    return stop, x, velocity, -1


@compiled
def _fastest(f, low, high, rate, following, o, p):
    """Time of the extreme velocity between two times (s after f) with accelerations of opposite sign.

    The velocity there is off by the square of the error in time only: few iterations do.
    """
    time = low + (high - low) * rate / (rate - following)
    for _ in range(3):
        g = after(f, time, o, p)
        jerk = -o.forced * p.omega**3 * g.cosine - o.frequency**3 * g.quadrature
        if jerk != 0.0:
            time = min(max(time - acceleration(g, o, p) / jerk, low), high)
    return time


@compiled
def _keep_until(time, weight, f, earlier, rate, t, contact, o, recorder, p):
    """Keep the state some time after f (at t), and an extreme velocity on the way; the acceleration there."""
    g = after(f, time, o, p)
    now = acceleration(g, o, p)
    if rate * now < 0.0:
        fastest = _fastest(f, earlier, time, rate, now, o, p)
        x, velocity = state(after(f, fastest, o, p), o, p)
        put_node(t + fastest, x, velocity, 0.0, contact, recorder, p)
    x, velocity = state(g, o, p)
    put_node(t + time, x, velocity, weight, contact, recorder, p)
    return now


@compiled
def keep(t, end, x, velocity, contact, o, recorder, p):
    """Keep a piece that ``slide`` has followed from the state at t to ``end``."""
    f = phase_of(t, x, velocity, o, p)
    put_node(t, x, velocity, 0.0, contact, recorder, p)
    earlier, rate = 0.0, acceleration(f, o, p)
    parts = int((end - t) * max(p.omega, o.frequency) / (2.0 * pi) * 12.0) + 1
    span = (end - t) / parts
    for part in range(parts):
        for node in range(len(NODES)):
            time = span * (part + NODES[node])
            rate = _keep_until(time, span * WEIGHTS[node], f, earlier, rate, t, contact, o, recorder, p)
            earlier = time
    _keep_until(end - t, 0.0, f, earlier, rate, t, contact, o, recorder, p)
    for i in range(first_sample(t, recorder), first_sample(end, recorder)):
        x, velocity = state(after(f, recorder.start + i * recorder.step - t, o, p), o, p)
        put_sample(i, x, velocity, contact, recorder)
