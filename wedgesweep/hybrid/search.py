"""Zeros and minima of functions of one variable: how all events are located.

A function has the arguments (place, context). The type of the context, a NamedTuple, says which function it
is: numba cannot cache code that takes functions as arguments. The same search serves event functions on the
dense output of a step, along a closed form, and of a system at rest.
"""

from collections.abc import Callable
from math import inf
from typing import NamedTuple, TypeVar

from numba.core import types

from wedgesweep.compiled import by_type, inlined, inner

GOLDEN = 0.6180339887498949
MOST_ITERATIONS = 100
# A change of the place, as a share of the first bracket, after which only rounding errors are left: of the
# secant method, and of Newton's, which squares the error.
LAST_CHANGE, LAST_CHANGE_BY_SLOPE = 1e-10, 1e-7
# Of ``first_zero``: error of the place as a share of its unit, that of a minimum as a share of the interval,
# and the distance from a start that is a zero in which no other one is sought.
ROUNDING, GRAZING, NEAREST = 1e-15, 1e-9, 1e-12

Function = TypeVar("Function", bound=Callable)
_FUNCTIONS: dict[type, Callable] = {}


def searched(context: type) -> Callable[[Function], Function]:
    """Register a compiled function of (place, context) for a type of context.

    It returns its value and its slope, or NaN for an unknown slope.
    """

    def decorate(function: Function) -> Function:
        _FUNCTIONS[context] = function
        return function

    return decorate


def _value(place, context):
    """The function of a context, at a place."""


@by_type(_value)
def _of_context(place, context):
    if not isinstance(context, types.NamedTuple | types.NamedUniTuple):
        return None
    return _FUNCTIONS[context.instance_class]


class Bracket(NamedTuple):
    """Two places and the values of a function: positive at ``low``, not positive at ``high``."""

    low: float
    at_low: float
    high: float
    at_high: float


class Sample(NamedTuple):
    """Value of a function at a time, and its time derivative."""

    value: float
    slope: float


@inlined
def sample(place, context):
    """The function of a context at a place."""
    return Sample(*_value(place, context))


@inlined
def may_graze(before, after, span):
    """Whether a function may be negative between two positive samples.

    It may if its tangents meet near zero or below: between samples this close a function with a minimum is
    convex, and lies above its tangents.
    """
    falling, rising = before.slope, after.slope
    if not falling < 0.0 < rising:
        return False
    lowest = (rising * before.value - falling * after.value + falling * rising * span) / (rising - falling)
    return lowest < 0.1 * before.value


@inlined
def crossing(before, after, span):
    """Estimate of the time in an interval at which a function is zero that changes its sign there.

    Hermite's cubic for time as a function of the value; linear where the function turns in the interval.
    """
    rise, start, end = after.value - before.value, before.slope, after.slope
    share = -before.value / rise
    if not (start * rise > 0.0 and end * rise > 0.0):
        return share * span
    rest = 1.0 - share
    return share * (share * (3.0 - 2.0 * share) * span + rest * rise * (rest / start - share / end))


@inlined
def zero(context, bracket, close):
    """Place in a bracket at which a function is zero, to within ``close``."""
    low, at_low, high, at_high = bracket
    return zero_near(context, bracket, high - at_high * (high - low) / (at_high - at_low), close)


@inner
def zero_near(context, bracket, place, close):
    """As ``zero``, from a first estimate of the place.

    Newton's method, or the secant method where the slope is unknown. A step that leaves the bracket is
    replaced by one of the Illinois method (regula falsi).
    """
    low, at_low, high, at_high = bracket
    width = high - low
    before, at_before = (low, at_low) if at_low < -at_high else (high, at_high)
    for _ in range(MOST_ITERATIONS):
        if not low < place < high:
            place = 0.5 * (low + high)
        value, slope = _value(place, context)
        if value == 0.0 or high - low < close:
            return place
        negligible = max(close, LAST_CHANGE_BY_SLOPE * width)
        if slope != slope:  # NaN: not known
            slope = (value - at_before) / (place - before)
            negligible = max(close, LAST_CHANGE * width)
        before, at_before = place, value
        newton = place - value / slope
        if value > 0.0:
            if place - low < close:
                return place
            low, at_low = place, value
            at_high *= 0.5
        else:
            if high - place < close:
                return place
            high, at_high = place, value
            at_low *= 0.5
        if low <= newton <= high:
            if abs(newton - place) < negligible:
                return newton
            place = newton
        else:
            place = high - at_high * (high - low) / (at_high - at_low)
    return high


@inner
def zero_after_start(context, bracket, nearest, close):
    """As ``zero``, of a function that is zero at the low end and positive after it.

    The low end itself if halving the bracket finds no positive value farther than ``nearest`` from it.
    """
    start, _, high, at_high = bracket
    place = 0.5 * (start + high)
    while place - start > nearest:
        value = _value(place, context)[0]
        if value > 0.0:
            return zero(context, Bracket(place, value, high, at_high), close)
        high, at_high = place, value
        place = 0.5 * (start + high)
    return start


@inner
def minimum(context, low, high, close):
    """Place between two others where a function is smallest, or the first one found where it is <= 0.

    By golden section.
    """
    left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_left, at_right = _value(left, context)[0], _value(right, context)[0]
    # The count ends a search whose places are too large for rounding to let them come this close.
    for _ in range(MOST_ITERATIONS):
        if high - low <= close:
            break
        if at_left <= 0.0:
            return left
        if at_right <= 0.0:
            return right
        if at_left < at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = _value(left, context)[0]
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = _value(right, context)[0]
    return 0.5 * (low + high)


@inner
def first_zero(context, low, span, before, after, from_zero, unit):
    """Place at which a function is first zero between two samples ``span`` apart; inf: nowhere.

    ``low``: place of the first one. ``from_zero``: the function is zero there. ``unit``: of places.
    """
    high, value = low + span, after.value
    if value > 0.0 and not from_zero and may_graze(before, after, span):
        high = minimum(context, low, high, GRAZING * span)
        value = _value(high, context)[0]
    if value > 0.0:
        return inf
    bracket = Bracket(low, before.value, high, value)
    if from_zero or before.value <= 0.0:
        return zero_after_start(context, bracket, NEAREST * unit, ROUNDING * unit)
    return zero_near(context, bracket, low + crossing(before, after, span), ROUNDING * unit)
