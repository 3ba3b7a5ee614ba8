"""Slip under friction that varies with velocity: Dormand and Prince's 5(4) pair (1980).

Adaptive steps with the first-same-as-last stage; between steps the quintic through deflection, velocity
and acceleration at both ends. A switch is located on that quintic.
"""

from math import inf, pi, sqrt

from wedgesweep import excitation
from wedgesweep.compiled import compiled, inlined
from wedgesweep.contact import COLUMN_NORMAL, SWITCHES, acting, held, slip_switches, switches, unique
from wedgesweep.solvers.recorder import NODES, WEIGHTS, first_sample, put_node, put_sample
from wedgesweep.solvers.sticking import LOCKED

# Share of the input amplitude and velocity, times rtol, that an error may always have.
ABSOLUTE = 1e-2
# Steps per forcing period at the least; a longer one could step over a whole motion.
LEAST = 12
SAFETY, SHRINK, GROW = 0.9, 0.2, 5.0
SHORTEST = 1e-13
# A piece that needs more steps than this per forcing period will not end.
MOST_STEPS = 100_000
FAILED = -3


@inlined
def rate(t, x, velocity, contact, p):
    """X'' in m/s^2."""
    return acting(x, velocity, excitation.acceleration(t, p), contact, p).acceleration


@compiled
def step(t, h, x, v, a, contact, p):
    """One step from (x, v) with acceleration a: the new state, the forces there, and two errors."""
    a2 = rate(t + h / 5, x + h * v / 5, v + h * a / 5, contact, p)
    v2 = v + h * a / 5
    v3 = v + h * (3 / 40 * a + 9 / 40 * a2)
    a3 = rate(t + 3 / 10 * h, x + h * (3 / 40 * v + 9 / 40 * v2), v3, contact, p)
    v4 = v + h * (44 / 45 * a - 56 / 15 * a2 + 32 / 9 * a3)
    x4 = x + h * (44 / 45 * v - 56 / 15 * v2 + 32 / 9 * v3)
    a4 = rate(t + 4 / 5 * h, x4, v4, contact, p)
    v5 = v + h * (19372 / 6561 * a - 25360 / 2187 * a2 + 64448 / 6561 * a3 - 212 / 729 * a4)
    x5 = x + h * (19372 / 6561 * v - 25360 / 2187 * v2 + 64448 / 6561 * v3 - 212 / 729 * v4)
    a5 = rate(t + 8 / 9 * h, x5, v5, contact, p)
    v6 = v + h * (9017 / 3168 * a - 355 / 33 * a2 + 46732 / 5247 * a3 + 49 / 176 * a4 - 5103 / 18656 * a5)
    x6 = x + h * (9017 / 3168 * v - 355 / 33 * v2 + 46732 / 5247 * v3 + 49 / 176 * v4 - 5103 / 18656 * v5)
    a6 = rate(t + h, x6, v6, contact, p)
    v7 = v + h * (35 / 384 * a + 500 / 1113 * a3 + 125 / 192 * a4 - 2187 / 6784 * a5 + 11 / 84 * a6)
    x7 = x + h * (35 / 384 * v + 500 / 1113 * v3 + 125 / 192 * v4 - 2187 / 6784 * v5 + 11 / 84 * v6)
    now = acting(x7, v7, excitation.acceleration(t + h, p), contact, p)
    a7 = now.acceleration
    error_x = h * (
        71 / 57600 * v - 71 / 16695 * v3 + 71 / 1920 * v4 - 17253 / 339200 * v5 + 22 / 525 * v6 - v7 / 40
    )
    error_v = h * (
        71 / 57600 * a - 71 / 16695 * a3 + 71 / 1920 * a4 - 17253 / 339200 * a5 + 22 / 525 * a6 - a7 / 40
    )
    return x7, v7, now, error_x, error_v


@inlined
def quintic(s, h, start, end):
    """Deflection, velocity and acceleration at share s of a step, from both ends (x, v, a)."""
    x0, v0, a0 = start[0], start[1] * h, start[2] * h * h
    x1, v1, a1 = end[0], end[1] * h, end[2] * h * h
    rise = x1 - x0 - v0 - 0.5 * a0
    turn = v1 - v0 - a0
    bend = a1 - a0
    c3 = 10.0 * rise - 4.0 * turn + 0.5 * bend
    c4 = -15.0 * rise + 7.0 * turn - bend
    c5 = 6.0 * rise - 3.0 * turn + 0.5 * bend
    x = x0 + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))))
    v = v0 + s * (a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))
    a = a0 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))
    return x, v / h, a / (h * h)


@compiled
def _switches_at(s, t, h, start, end, contact, p, out):
    """Write all switching functions at share s of a step."""
    x, v, _ = quintic(s, h, start, end)
    switches(t + s * h, x, v, contact, p, out)


@compiled
def _slip_zero(target, low, high, h, start, end):
    """Share of a step between two others at which the velocity reaches a target."""
    at_low = quintic(low, h, start, end)[1] - target
    at_high = quintic(high, h, start, end)[1] - target
    share = low + (high - low) * at_low / (at_low - at_high)
    for _ in range(60):
        _, v, a = quintic(share, h, start, end)
        if (v - target) * at_low > 0.0:
            low = share
        else:
            high = share
        newton = share - (v - target) / (a * h) if a != 0.0 else low
        if abs(newton - share) <= 1e-14:
            return newton
        share = newton if low < newton < high else 0.5 * (low + high)
    return share


@compiled
def _force_zero(place, low, high, t, h, start, end, contact, p, out):
    """Share of a step at which a switch of forces, positive at ``low`` and not at ``high``, is zero."""
    for _ in range(55):
        middle = 0.5 * (low + high)
        _switches_at(middle, t, h, start, end, contact, p, out)
        if out[place] > 0.0:
            low = middle
        else:
            high = middle
    return high


@compiled
def _extreme(what, share, h, start, end):
    """Share of a step, below the given one, at which x (0) or the velocity (1) is extreme.

    Its derivative has opposite signs at the start and at that share. What is extreme is off by the square of
    the error in time only, so that 30 halvings leave none.
    """
    low, high = 0.0, share
    for _ in range(30):
        middle = 0.5 * (low + high)
        if quintic(middle, h, start, end)[what + 1] * start[what + 1] > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@compiled
def _zero(place, share, now, t, h, start, end, contact, p, last_switch, out):
    """Share of a step at which a switch is zero, which has the value ``now`` <= 0 at the given share.

    0 if a switch that begins at zero has no positive part that this step can see.
    """
    _switches_at(0.0, t, h, start, end, contact, p, out)
    before, low = out[place], 0.0
    if before <= 0.0 or (last_switch >= 0 and place // 2 == last_switch // 2):
        low = 0.5 * share
        while True:
            _switches_at(low, t, h, start, end, contact, p, out)
            if out[place] > 0.0:
                before = out[place]
                break
            low *= 0.5
            if low * h * p.omega < 1e-13:
                return 0.0
    if place >= COLUMN_NORMAL or held(contact):
        return _force_zero(place, low, share, t, h, start, end, contact, p, out)
    # A switch of slip is linear in the velocity, so that its zero is a velocity.
    at_low, at_share = quintic(low, h, start, end)[1], quintic(share, h, start, end)[1]
    target = at_low + (at_share - at_low) * before / (before - now)
    return _slip_zero(target, low, share, h, start, end)


@compiled
def _first_switch(share, t, h, start, end, contact, last_switch, p, work):
    """Share and place of the first switch up to a share of a step, where they are ``work.switches``.

    The place is -1 if all of them are positive.
    """
    earliest, first = 1.0, -1
    for place in range(SWITCHES):
        now = work.switches[place]
        if now <= 0.0:
            zero = _zero(place, share, now, t, h, start, end, contact, p, last_switch, work.trial)
            if first < 0 or zero < earliest:
                earliest, first = zero, place
    return earliest, first


@compiled
def slide(t, stop, x, v, contact, last_switch, h, p, keeping, recorder, work):
    """Follow slip until its first switch or ``stop``, beginning with a step h (s).

    Returns time, x, velocity, the switch (-1: none, LOCKED, FAILED) and the step to go on with.
    """
    longest = 2.0 * pi / p.omega / LEAST
    a, jump = rate(t, x, v, contact, p), held(contact)
    most = work.counts[1] + MOST_STEPS * (1.0 + (stop - t) / (LEAST * longest))
    while t < stop:
        h = min(h, longest)
        taken = min(h, stop - t)
        x1, v1, forces, error_x, error_v = step(t, taken, x, v, a, contact, p)
        error = _error(error_x, error_v, x, v, x1, v1, work.rtol, p)
        work.counts[0] += 6
        if not error <= 1.0:
            h = taken * max(SHRINK, SAFETY * error**-0.2) if error < inf else taken * SHRINK
            if h < SHORTEST * longest:
                return t, x, v, FAILED, h
            continue
        work.counts[1] += 1
        if work.counts[1] > most:
            return t, x, v, FAILED, h
        start, end = (x, v, a), (x1, v1, forces.acceleration)
        share, place = _earliest(t, taken, start, end, forces, jump, contact, last_switch, p, work)
        if keeping:
            keep(t, taken, share, start, end, contact, recorder, p)
        if place >= 0:
            x, v, a = quintic(share, taken, start, end)
            return t + share * taken, x, v, place, h
        if not unique(t + taken, x1, v1, contact, p):
            return t, x, v, LOCKED, h
        t = stop if taken == stop - t else t + taken
        x, v, a, last_switch = x1, v1, forces.acceleration, -1
        grown = taken * min(GROW, SAFETY * max(error, 1e-10) ** -0.2)
        h = max(h, grown) if taken < h else grown
    return stop, x, v, -1, h


@compiled
def _error(error_x, error_v, x, v, x1, v1, rtol, p):
    """Error of a step over what the tolerance allows."""
    size_x, size_v = ABSOLUTE * p.amplitude, ABSOLUTE * p.amplitude * p.omega
    scaled_x = error_x / (rtol * (size_x + max(abs(x), abs(x1))))
    scaled_v = error_v / (rtol * (size_v + max(abs(v), abs(v1))))
    return sqrt(0.5 * (scaled_x**2 + scaled_v**2))


@compiled
def _earliest(t, h, start, end, forces, jump, contact, last_switch, p, work):
    """Share of a step and place of its first switch; (1, -1) if there is none.

    A switch of slip may come and go within a step: then it is passed where the velocity is extreme.
    """
    if start[2] * end[2] < 0.0:
        peak = _extreme(1, 1.0, h, start, end)
        _switches_at(peak, t, h, start, end, contact, p, work.switches)
        share, place = _first_switch(peak, t, h, start, end, contact, last_switch, p, work)
        if place >= 0:
            return share, place
    if jump:
        switches(t + h, end[0], end[1], contact, p, work.switches)
    else:
        slip_switches(end[1], forces, contact, p, work.switches)
    return _first_switch(1.0, t, h, start, end, contact, last_switch, p, work)


@compiled
def keep(t, h, share, start, end, contact, recorder, p):
    """Keep a step up to some share of it."""
    put_node(t, start[0], start[1], 0.0, contact, recorder, p)
    for node in range(len(NODES)):
        s = share * NODES[node]
        x, v, _ = quintic(s, h, start, end)
        put_node(t + s * h, x, v, share * h * WEIGHTS[node], contact, recorder, p)
    last = quintic(share, h, start, end)
    put_node(t + share * h, last[0], last[1], 0.0, contact, recorder, p)
    for what in range(2):
        if start[what + 1] * last[what + 1] < 0.0:
            s = _extreme(what, share, h, start, end)
            x, v, _ = quintic(s, h, start, end)
            put_node(t + s * h, x, v, 0.0, contact, recorder, p)
    for i in range(first_sample(t, recorder), first_sample(t + share * h, recorder)):
        x, v, _ = quintic((recorder.start + i * recorder.step - t) / h, h, start, end)
        put_sample(i, x, v, contact, recorder)
