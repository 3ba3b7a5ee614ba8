"""How long set-valued friction holds the bolster: the release needs no integration.

While stuck only the base moves, so that the switches are known functions of time. They are sampled
over short intervals; a dip between samples is looked for where the samples turn.
"""

from math import inf

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.contact import SWITCHES, switches, unique

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
def release(t, stop, x, contact, parameters):
    """Time at which a stuck bolster lets go, and the switch that says so.

    The place is HELD if nothing happens before ``stop``, and LOCKED where release has no unique answer.
    """
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
