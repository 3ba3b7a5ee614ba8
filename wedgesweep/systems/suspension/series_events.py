"""Where a motion that is a power series ends its mode: the velocity leaves a branch of friction of a face."""

from math import inf
from typing import Any, NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.hybrid.polynomials import largest_change, polynomial, slope
from wedgesweep.hybrid.search import first_zero, may_graze, sample, searched
from wedgesweep.hybrid.state import NO_EVENT
from wedgesweep.systems.suspension.modes import BOLSTER, COLUMN

# Intervals of a step that are scanned for events.
SCANNED = 4


class Ends(NamedTuple):
    """The velocities z' (m/s) between which a mode lasts, and the events there (NO_EVENT: none)."""

    low: float
    low_event: int
    high: float
    high_event: int


@inlined
def _narrowed(ends, ratio, axis, branch, p):
    """The ends of a mode that also ends where the slip velocity of a face, ratio z', leaves its branch."""
    if ratio == 0.0:
        return ends
    threshold = p.friction.v_t * (1.0 + friction.OVERLAP) if branch == 0 else p.friction.v_t
    low = -inf if branch < 0 else threshold if branch > 0 else -threshold
    high = inf if branch > 0 else -threshold if branch < 0 else threshold
    low, low_event, high, high_event = low / ratio, 2 * axis, high / ratio, 2 * axis + 1
    if ratio < 0.0:
        low, low_event, high, high_event = high, high_event, low, low_event
    if low <= ends.low:
        low, low_event = ends.low, ends.low_event
    if high >= ends.high:
        high, high_event = ends.high, ends.high_event
    return Ends(low, low_event, high, high_event)


@inlined
def ends_of(mode, p):
    """The ends of a mode."""
    ends = _narrowed(Ends(-inf, NO_EVENT, inf, NO_EVENT), p.geometry.column_ratio, COLUMN, mode.column, p)
    return _narrowed(ends, p.geometry.bolster_ratio, BOLSTER, mode.bolster, p)


class _Velocity(NamedTuple):
    """How far the velocity of a series is above a bound (m/s), times a sign."""

    bound: float
    sign: float
    coefficients: Any


@searched(_Velocity)
@inlined
def _inside(time, velocity):
    value = polynomial(velocity.coefficients, time) - velocity.bound
    return velocity.sign * value, velocity.sign * slope(velocity.coefficients, time)


@inner
def _time_to_end(velocity, h, from_zero, p):
    """Time (s) in a step at which the velocity first reaches the bound; inf: it does not."""
    span, before = h / SCANNED, sample(0.0, velocity)
    for i in range(SCANNED):
        after = sample((i + 1) * span, velocity)
        if after.value <= 0.0 or may_graze(before, after, span):
            at_zero = from_zero and i == 0
            time = first_zero(velocity, i * span, span, before, after, at_zero, 1.0 / p.input.omega)
            if time < inf:
                return time
        before = after
    return inf


@inlined
def first_event(velocity, h, last_event, ends, p):
    """Time (s) and number of the first event in a step h (s); (inf, NO_EVENT) if there is none.

    ``velocity``: coefficients of z'. An event of the same face may have led to the mode.
    """
    change, pair, found = largest_change(velocity, h), last_event // 2, (inf, NO_EVENT)
    if not velocity[0] - change > ends.low:
        time = _time_to_end(_Velocity(ends.low, 1.0, velocity), h, pair == ends.low_event // 2, p)
        found = time, ends.low_event
    if not velocity[0] + change < ends.high:
        time = _time_to_end(_Velocity(ends.high, -1.0, velocity), h, pair == ends.high_event // 2, p)
        found = (time, ends.high_event) if time < found[0] else found
    return found if found[0] < inf else (inf, NO_EVENT)
