"""A step of an integrator with its dense output, and its error against the tolerance."""

from math import sqrt
from typing import Any, NamedTuple

from wedgesweep.compiled import inlined
from wedgesweep.hybrid.interface import error_scales
from wedgesweep.hybrid.vectors import combination, weighted

# Share of a state's natural size, times rtol, that an error may always have.
ABSOLUTE = 1e-2
# Shortest step, as a share of a period of the fastest input; a mode that needs a shorter one has failed. One
# that needs more steps than MOST_STEPS per period will not end.
SHORTEST, MOST_STEPS = 1e-13, 100_000


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
def step_through(t, h, start, middle, end, start_rate, end_rate):
    """A step whose dense output also meets the state in its middle."""
    step = with_dense_output(t, h, start, end, start_rate, end_rate, start)
    weights = (16.0, -16.0, -8.0, -4.0, -2.0)
    quartic = combination(1.0, weights, (middle, start, step.rise, step.bend, step.turn))
    return Step(t, h, start, end, start_rate, end_rate, step.rise, step.bend, step.turn, quartic)


@inlined
def dense_output(share, step):
    """State at a share of a step."""
    rest = 1.0 - share
    mixed = share * rest
    weights = (share, mixed, share * mixed, mixed * mixed)
    return weighted(step.start, 1.0, weights, (step.rise, step.bend, step.turn, step.quartic))


@inlined
def dense_slope(share, step):
    """Derivative of ``dense_output`` by the share."""
    rest = 1.0 - share
    weights = (1.0, rest - share, share * (2.0 - 3.0 * share), 2.0 * share * rest * (rest - share))
    return combination(1.0, weights, (step.rise, step.bend, step.turn, step.quartic))


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
