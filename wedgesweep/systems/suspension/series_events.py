"""The first event of a motion that is a power series: all event functions follow from polynomials then.

The velocity leaves a branch of friction of one of the faces, or a normal force vanishes.
"""

from math import inf
from typing import Any, NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import inlined
from wedgesweep.hybrid.polynomials import largest_change, polynomial, slope
from wedgesweep.hybrid.search import Sample, first_zero, may_graze, sample, searched
from wedgesweep.hybrid.state import NO_EVENT
from wedgesweep.systems.suspension.events import BOLSTER_NORMAL, COLUMN_NORMAL
from wedgesweep.systems.suspension.modes import BOLSTER, COLUMN
from wedgesweep.systems.suspension.rational import rational

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
def _above(time, velocity):
    value = polynomial(velocity.coefficients, time) - velocity.bound
    return velocity.sign * value, velocity.sign * slope(velocity.coefficients, time)


class _NormalForce(NamedTuple):
    """A normal force (N) of a series, times a sign."""

    sign: int
    numerator: Any
    determinant: Any
    series: Any


@inlined
def _at(time, coefficients):
    return Sample(polynomial(coefficients, time), slope(coefficients, time))


@searched(_NormalForce)
@inlined
def _force(time, force):
    series = force.series
    x, u2 = _at(time, series.x), _at(time, series.u2)
    column, bolster = _at(time, series.column_mu), _at(time, series.bolster_mu)
    found = rational(force.numerator, force.determinant, x, u2, column, bolster)
    return force.sign * found.value, force.sign * found.slope


@inlined
def _earlier(found, context, h, from_zero, event, p):
    """The first event so far in a step, its time (s) and number, or another one if it is earlier."""
    span, before = h / SCANNED, sample(0.0, context)
    for i in range(SCANNED):
        after = sample((i + 1) * span, context)
        if after.value <= 0.0 or may_graze(before, after, span):
            at_zero = from_zero and i == 0
            time = first_zero(context, i * span, span, before, after, at_zero, 1.0 / p.input.omega)
            if time < inf:
                return (time, event) if time < found[0] else found
        before = after
    return found


@inlined
def first_event(series, h, last_event, ends, forces, mode, p):
    """Time (s) and number of the first event in a step h (s); (inf, NO_EVENT) if there is none."""
    v, change, found = series.velocity, largest_change(series.velocity, h), (inf, NO_EVENT)
    # An event of the same face may have led to the mode.
    pair = last_event // 2
    if not v[0] - change > ends.low:
        low = _Velocity(ends.low, 1.0, v)
        found = _earlier(found, low, h, pair == ends.low_event // 2, ends.low_event, p)
    if not v[0] + change < ends.high:
        high = _Velocity(ends.high, -1.0, v)
        found = _earlier(found, high, h, pair == ends.high_event // 2, ends.high_event, p)
    pull = mode.column_sign < 0 or mode.bolster_sign < 0
    if pull or not abs(series.x[0]) + largest_change(series.x, h) < forces.loaded:
        column = _NormalForce(mode.column_sign, forces.column, forces.determinant, series)
        found = _earlier(found, column, h, last_event == COLUMN_NORMAL, COLUMN_NORMAL, p)
        bolster = _NormalForce(mode.bolster_sign, forces.bolster, forces.determinant, series)
        found = _earlier(found, bolster, h, last_event == BOLSTER_NORMAL, BOLSTER_NORMAL, p)
    return found
