"""Where a power series of a motion ends its mode: it leaves a branch of friction or a segment of travel."""

from math import inf
from typing import Any, NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import guide_friction, travel
from wedgesweep.hybrid.polynomials import largest_change, polynomial, slope
from wedgesweep.hybrid.search import first_zero, may_graze, sample, searched
from wedgesweep.hybrid.state import NO_EVENT
from wedgesweep.systems.suspension.events import TRAVEL
from wedgesweep.systems.suspension.modes import BOLSTER, COLUMN, DIRECTION, GUIDE

# Intervals of a step that are scanned for events.
SCANNED = 4


class Ends(NamedTuple):
    """Two bounds of a number between which a mode lasts, and the events there (NO_EVENT: none)."""

    low: float
    low_event: int
    high: float
    high_event: int


@inlined
def _narrower(one, other):
    """Where both last."""
    low, high = one[:2], one[2:]
    if other.low >= one.low:
        low = other.low, other.low_event
    if other.high <= one.high:
        high = other.high, other.high_event
    return Ends(*low, *high)


@inlined
def _of_branch(ratio, axis, branch, p):
    """The ends of a branch of an axis whose slip velocity is ratio z'."""
    place = 2 * axis
    if ratio == 0.0:
        return Ends(-inf, NO_EVENT, inf, NO_EVENT)
    threshold = 0.0 if p.friction.set_valued else p.friction.v_t
    if branch == 0:
        threshold *= 1.0 + friction.OVERLAP
    low = -inf if branch < 0 else threshold if branch > 0 else -threshold
    high = inf if branch > 0 else -threshold if branch < 0 else threshold
    if ratio < 0.0:
        return Ends(high / ratio, place + 1, low / ratio, place)
    return Ends(low / ratio, place, high / ratio, place + 1)


@inlined
def ends_of_velocity(mode, p):
    """The ends of a mode of slip in z' (m/s); under a set-valued law it lasts while z' keeps its sign."""
    ends = _of_branch(p.geometry.column_ratio, COLUMN, mode.column, p)
    if p.friction.set_valued:
        return ends
    ends = _narrower(ends, _of_branch(p.geometry.bolster_ratio, BOLSTER, mode.bolster, p))
    if guide_friction.acts(p):
        ends = _narrower(ends, _of_branch(1.0, GUIDE, mode.guide, p))
    if mode.direction > 0:
        ends = _narrower(ends, Ends(0.0, 2 * DIRECTION, inf, NO_EVENT))
    if mode.direction < 0:
        ends = _narrower(ends, Ends(-inf, NO_EVENT, 0.0, 2 * DIRECTION + 1))
    return ends


@inlined
def ends_of_displacement(mode, p):
    """The ends of a mode in x (m): those of a segment of the travel."""
    low, high = travel.ends(mode.segment, p)
    return Ends(low, TRAVEL, high, TRAVEL + 1)


class _Distance(NamedTuple):
    """How far a series is above a bound, times a sign."""

    bound: float
    sign: float
    coefficients: Any


@searched(_Distance)
@inlined
def _inside(time, distance):
    value = polynomial(distance.coefficients, time) - distance.bound
    return distance.sign * value, distance.sign * slope(distance.coefficients, time)


@inner
def _time_to_end(distance, h, from_zero, p):
    """Time (s) in a step at which a distance is first zero; inf: it is not."""
    span, before = h / SCANNED, sample(0.0, distance)
    for i in range(SCANNED):
        after = sample((i + 1) * span, distance)
        if after.value <= 0.0 or may_graze(before, after, span):
            at_zero = from_zero and i == 0
            time = first_zero(distance, i * span, span, before, after, at_zero, 1.0 / p.input.omega)
            if time < inf:
                return time
        before = after
    return inf


@inlined
def first_event(coefficients, h, last_event, ends, p):
    """Time (s) and number of the first event in a step h (s); (inf, NO_EVENT) if there is none.

    ``coefficients``: of what the ends are ends of. An event of the same pair may have led to the mode.
    """
    change, pair, found = largest_change(coefficients, h), last_event // 2, (inf, NO_EVENT)
    if not coefficients[0] - change > ends.low:
        time = _time_to_end(_Distance(ends.low, 1.0, coefficients), h, pair == ends.low_event // 2, p)
        found = time, ends.low_event
    if not coefficients[0] + change < ends.high:
        time = _time_to_end(_Distance(ends.high, -1.0, coefficients), h, pair == ends.high_event // 2, p)
        found = (time, ends.high_event) if time < found[0] else found
    return found if found[0] < inf else (inf, NO_EVENT)
