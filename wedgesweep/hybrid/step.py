"""A step of an integrator with its dense output, and its error against the tolerance."""

from math import sqrt
from typing import Any, NamedTuple

from wedgesweep.compiled import by_type, inlined
from wedgesweep.hybrid.interface import error_scales
from wedgesweep.hybrid.polynomials import polynomial, slope
from wedgesweep.hybrid.vectors import combination, weighted, with_motion

# Share of a state's natural size, times rtol, that an error may always have.
ABSOLUTE = 1e-2
# Shortest step, as a share of a period of the fastest input; a mode that needs a shorter one has failed.
SHORTEST = 1e-13
# A mode that needs more steps per period, or more in all, will not end: the latter are a minute or so.
MOST_STEPS, MOST_STEPS_IN_ALL = 100_000, 50_000_000


class Step(NamedTuple):
    """A step from t, h (s) long: states and rates at both ends, and the coefficients of its dense output.

    With s = share, y(s) = start + s (rise + (1 - s) (bend + s (turn + (1 - s) quartic))).
    """

    t: float
    h: float
    start: Any
    end: Any
    start_rate: Any
    end_rate: Any
    rise: Any
    bend: Any
    turn: Any
    quartic: Any


@inlined
def with_dense_output(t, h, start, end, start_rate, end_rate, quartic):
    """A step whose dense output is Hermite's cubic through both ends plus a term of order 4, ``quartic``."""
    rise = combination(1.0, (1.0, -1.0), (end, start))
    bend = combination(1.0, (h, -1.0), (start_rate, rise))
    turn = combination(1.0, (1.0, -h, -1.0), (rise, end_rate, bend))
    return Step(t, h, start, end, start_rate, end_rate, rise, bend, turn, quartic)


@inlined
def _quartic_output(share, step):
    rest = 1.0 - share
    mixed = share * rest
    weights = (share, mixed, share * mixed, mixed * mixed)
    return weighted(step.start, 1.0, weights, (step.rise, step.bend, step.turn, step.quartic))


@inlined
def _quartic_slope(share, step):
    rest = 1.0 - share
    weights = (1.0, rest - share, share * (2.0 - 3.0 * share), 2.0 * share * rest * (rest - share))
    return combination(1.0, weights, (step.rise, step.bend, step.turn, step.quartic))


class SeriesStep(NamedTuple):
    """A step from t, h (s) long, from a state ``start``: its first two are polynomials, the others rest."""

    t: float
    h: float
    start: Any
    coefficients: Any


@inlined
def _series_output(share, step):
    x, velocity = step.coefficients
    return with_motion(step.start, polynomial(x, share * step.h), polynomial(velocity, share * step.h))


@inlined
def _series_slope(share, step):
    (x, velocity), h = step.coefficients, step.h
    at_rest = combination(0.0, (1.0,), (step.start,))
    return with_motion(at_rest, h * slope(x, share * h), h * slope(velocity, share * h))


_OUTPUT = {Step: _quartic_output, SeriesStep: _series_output}
_SLOPE = {Step: _quartic_slope, SeriesStep: _series_slope}


def dense_output(share, step):
    """State at a share of a step."""
    raise NotImplementedError


@by_type(dense_output)
def _dense_output(share, step):
    return _OUTPUT[step.instance_class]


def dense_slope(share, step):
    """Derivative of ``dense_output`` by the share."""
    raise NotImplementedError


@by_type(dense_slope)
def _dense_slope(share, step):
    return _SLOPE[step.instance_class]


@inlined
def step_limit(taken, periods):
    """Steps after which a mode fails that began after ``taken`` of them and lasts ``periods`` at most."""
    return taken + min(MOST_STEPS * (1.0 + periods), MOST_STEPS_IN_ALL)


@inlined
def over_tolerance(error, y, end, rtol, p):
    """Error over the tolerance: root mean square over the states, but for those that are 0 at both ends."""
    scales = error_scales(p)
    total, count = 0.0, 0
    for i in range(len(y)):
        size = max(abs(y[i]), abs(end[i]))
        if size > 0.0:
            total += (error[i] / (rtol * (size + ABSOLUTE * scales[i]))) ** 2
            count += 1
    return sqrt(total / max(count, 1))
