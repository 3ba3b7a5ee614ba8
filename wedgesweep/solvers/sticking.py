"""How long set-valued friction holds the bolster: the release needs no integration.

While stuck only the base moves, so that the switches are known functions of time: in closed form
while both faces stay closed, else sampled over short intervals, with a look for a dip between samples
where the samples turn.
"""

from math import asin, ceil, inf, nan, pi, sin

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.contact import COLUMN, SWITCHES, slipping, switches, unique
from wedgesweep.damper import forces

SAMPLES_PER_PERIOD = 64
HELD, LOCKED = -1, -2
GOLDEN = 0.6180339887498949


@compiled
def _lowest(t, x, contact, p, out):
    """Smallest switch and its place at time t."""
    switches(t, x, 0.0, contact, p, out)
    place = int(np.argmin(out))
    return out[place], place


@compiled
def _dip(left, right, x, contact, p, out):
    """Time of the minimum of the smallest switch between two times (golden section)."""
    while right - left > 1e-9 * (abs(right) + abs(left)):
        inner, outer = right - GOLDEN * (right - left), left + GOLDEN * (right - left)
        if _lowest(inner, x, contact, p, out)[0] < _lowest(outer, x, contact, p, out)[0]:
            right = outer
        else:
            left = inner
    return 0.5 * (left + right)


@compiled
def _crossing(left, right, x, contact, p, out):
    """Last time in floating point before the smallest switch turns negative (bisection)."""
    while True:
        middle = 0.5 * (left + right)
        if middle <= left or middle >= right:
            return right
        if _lowest(middle, x, contact, p, out)[0] < 0.0:
            right = middle
        else:
            left = middle


@compiled
def _linear_release(x, direction, p):
    """Base acceleration at which a stuck bolster slips in a direction; NaN if a face opens there."""
    contact = slipping(direction, p)
    at_rest = forces(x, 0.0, 0.0, contact, p)
    driven = forces(x, 0.0, 1.0, contact, p)
    limit = at_rest.acceleration / (at_rest.acceleration - driven.acceleration)
    there = forces(x, 0.0, limit, contact, p)
    return limit if min(there.column, there.bolster) > 0.0 else nan


@compiled
def release(t, stop, x, contact, parameters):
    """Time at which a stuck bolster lets go, and the switch that says so.

    The place is HELD if nothing happens before ``stop``, and LOCKED where release has no unique answer.
    Between the two base accelerations that free the bolster it is stuck; with both faces closed there
    these are known, and so are the phases at which a harmonic base motion reaches them.
    """
    p = parameters[0]
    forward, backward = _linear_release(x, 1, p), _linear_release(x, -1, p)
    if not (p.never_locks and forward < backward):
        return scanned_release(t, stop, x, contact, parameters)
    most = p.amplitude * p.omega**2
    upper, lower = -forward / most, -backward / most  # of sin(omega t)
    phase = p.omega * t
    if sin(phase) > upper:
        return t, COLUMN + 1
    if sin(phase) < lower:
        return t, COLUMN
    turn = 2.0 * pi
    rising = falling = inf
    if upper < 1.0:
        rising = asin(upper)
        rising += turn * ceil((phase - rising) / turn)
    if lower > -1.0:
        falling = pi - asin(lower)
        falling += turn * ceil((phase - falling) / turn)
    moment = min(rising, falling) / p.omega
    if moment >= stop:
        return stop, HELD
    return moment, COLUMN + 1 if rising < falling else COLUMN


@compiled
def scanned_release(t, stop, x, contact, parameters):
    """``release`` for any base motion and for normal forces of either sign: sampled, then bisected."""
    p = parameters[0]
    out = np.empty(SWITCHES)
    step = 2.0 * np.pi / p.omega / SAMPLES_PER_PERIOD
    earlier, held = t, t
    before, now = inf, _lowest(t, x, contact, p, out)[0]
    while held < stop:
        if not unique(held, x, 0.0, contact, p):
            return held, LOCKED
        following = min(held + step, stop)
        after = _lowest(following, x, contact, p, out)[0]
        if after >= 0.0 and before > now and now < after:
            dip = _dip(earlier, following, x, contact, p, out)
            if _lowest(dip, x, contact, p, out)[0] < 0.0:
                held, following, after = earlier, dip, -1.0
        if after < 0.0:
            moment = _crossing(held, following, x, contact, p, out)
            return moment, _lowest(moment, x, contact, p, out)[1]
        earlier, before = held, now
        held, now = following, after
    return stop, HELD
