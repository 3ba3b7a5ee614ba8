"""Switches that pass zero and come back within a step, which looks at its ends only."""

from collections.abc import Callable
from math import inf
from typing import Any

import numpy as np
from scipy.optimize import brentq, minimize_scalar

# Error of a place in time, as a share of a step.
CLOSE = 1e-9


def cut(result: Any, values: Callable[[float], np.ndarray]) -> None:
    """Let a piece that ``solve_ivp`` made, with its dense output, end where a switch is first zero.

    ``values``: the switches (k,) at a time, in the order of the first k events.
    """
    at_ends = np.array([values(t) for t in result.t])
    for i in range(1, len(at_ends) - 1):
        lowest = (at_ends[i] <= at_ends[i - 1]) & (at_ends[i] <= at_ends[i + 1])
        found = [
            (_zero(values, k, result.t[i - 1], result.t[i + 1]), k) for k in np.flatnonzero(lowest).tolist()
        ]
        reached = min(found, default=(inf, 0))
        if reached[0] < inf:
            _end(result, *reached)
            return


def _zero(values: Callable[[float], np.ndarray], k: int, before: float, after: float) -> float:
    """When a switch is first zero between two times that its lowest value lies between; inf if never."""

    def value(t: float) -> float:
        return float(values(t)[k])

    close = CLOSE * (after - before)
    least = minimize_scalar(value, bounds=(before, after), method="bounded", options={"xatol": close})
    if value(before) <= 0.0 or least.fun >= 0.0:
        return inf
    return float(brentq(value, before, least.x, xtol=close))


def _end(result: Any, t: float, k: int) -> None:
    """End a piece at a time, with event k."""
    y = result.sol(t)
    kept = result.t < t
    result.t, result.y = np.append(result.t[kept], t), np.column_stack([result.y[:, kept], y])
    for i, times in enumerate(result.t_events):
        before = times < t
        result.t_events[i], result.y_events[i] = times[before], result.y_events[i][before]
    result.t_events[k], result.y_events[k] = np.array([t]), y[None]
