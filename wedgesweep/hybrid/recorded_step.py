"""Records a step: extremes, sums by quadrature, samples. Places in it are shares of its length."""

from math import nan
from typing import Any, NamedTuple

from wedgesweep.compiled import inner
from wedgesweep.hybrid.interface import observed
from wedgesweep.hybrid.recorder import NODES, WEIGHTS, first_sample, record_node, record_sample
from wedgesweep.hybrid.search import Bracket, searched, zero
from wedgesweep.hybrid.step import dense_output, dense_slope

# Error of the place of an extreme.
PLACE_OF_EXTREME = 1e-9


class _Velocity(NamedTuple):
    """Observed velocity on a step, times a sign."""

    sign: float
    step: Any
    p: Any


class _Acceleration(NamedTuple):
    """Derivative of the observed velocity by the share of a step, times a sign."""

    sign: float
    step: Any
    p: Any


@searched(_Velocity)
@inner
def _velocity(share, context):
    step, p = context.step, context.p
    velocity = observed(dense_output(share, step), p)[1]
    return context.sign * velocity, context.sign * observed(dense_slope(share, step), p)[1]


@searched(_Acceleration)
@inner
def _acceleration(share, context):
    return context.sign * observed(dense_slope(share, context.step), context.p)[1], nan


@inner
def _record_extremes(share, step, mode, recorder, p):
    """Record the extremes of displacement and velocity in a step up to a share of it."""
    first, last = _velocity(0.0, _Velocity(1.0, step, p))[0], _velocity(share, _Velocity(1.0, step, p))[0]
    if first * last < 0.0:
        turning = _Velocity(1.0 if first > 0.0 else -1.0, step, p)
        there = zero(turning, Bracket(0.0, abs(first), share, -abs(last)), PLACE_OF_EXTREME)
        record_node(step.t + there * step.h, dense_output(there, step), 0.0, mode, recorder, p)
    upward = _Acceleration(1.0, step, p)
    first, last = _acceleration(0.0, upward)[0], _acceleration(share, upward)[0]
    if first * last < 0.0:
        peak = _Acceleration(1.0 if first > 0.0 else -1.0, step, p)
        there = zero(peak, Bracket(0.0, abs(first), share, -abs(last)), PLACE_OF_EXTREME)
        record_node(step.t + there * step.h, dense_output(there, step), 0.0, mode, recorder, p)


@inner
def _add_step(step, share, mode, recorder, p):
    """Add a step up to a share of it to the sums."""
    t, h, end = step.t, step.h, dense_output(share, step)
    record_node(t, step.start, 0.0, mode, recorder, p)
    for node in range(len(NODES)):
        there = share * NODES[node]
        record_node(t + there * h, dense_output(there, step), share * h * WEIGHTS[node], mode, recorder, p)
    record_node(t + share * h, end, 0.0, mode, recorder, p)
    _record_extremes(share, step, mode, recorder, p)


@inner
def record_step(step, share, mode, recorder, p):
    """Record a step up to a share of it."""
    if recorder.summed:
        _add_step(step, share, mode, recorder, p)
    t, h = step.t, step.h
    for i in range(first_sample(t, recorder), first_sample(t + share * h, recorder)):
        place = (recorder.start + i * recorder.step - t) / h
        record_sample(i, dense_output(place, step), mode, recorder, p)
