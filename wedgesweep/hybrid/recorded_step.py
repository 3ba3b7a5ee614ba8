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


class _Rate(NamedTuple):
    """Observed velocity on a step, or its derivative by the share of the step (``order`` 1), times a sign."""

    order: int
    sign: float
    step: Any
    p: Any


@searched(_Rate)
@inner
def _signed(share, rate):
    slope = rate.sign * observed(dense_slope(share, rate.step), rate.p)[1]
    if rate.order == 1:
        return slope, nan
    return rate.sign * observed(dense_output(share, rate.step), rate.p)[1], slope


@inner
def _record_extremes(share, step, mode, recorder, p):
    """Record the extremes of displacement and velocity in a step up to a share of it."""
    for order in range(2):
        rate = _Rate(order, 1.0, step, p)
        first, last = _signed(0.0, rate)[0], _signed(share, rate)[0]
        if first * last < 0.0:
            falling = _Rate(order, 1.0 if first > 0.0 else -1.0, step, p)
            there = zero(falling, Bracket(0.0, abs(first), share, -abs(last)), PLACE_OF_EXTREME)
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
