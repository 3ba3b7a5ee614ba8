"""Running sums over the kept window of a run: all results that need no waveform.

A solver adds points as it goes: nodes of a quadrature in time with their weights, and points of weight 0
where a mode begins or ends and where displacement or velocity is extreme.
"""

from math import inf

import numpy as np

from wedgesweep.compiled import by_record, compiled, inlined, inner
from wedgesweep.hybrid.interface import impact, observed, opened, powers, provided, sticks

SUMS = np.dtype(
    [
        (name, np.float64)
        for name in (
            "lowest",  # displacement (m)
            "highest",
            "peak_velocity",  # m/s
            "time",  # s
            "integral",  # of the displacement (m s)
            "stuck_time",  # s
            "lifted_time",  # s with a negative normal force
            "first_least",  # normal forces of both contacts (N), where they are determined
            "first_most",
            "first_sum",  # integral (N s)
            "second_least",
            "second_most",
            "second_sum",
            "determined",  # s
            "dissipated",  # J
            "supplied",  # J, by the input
            "onsets",  # of sticking
            "began_stuck",
            "is_stuck",
            "first_open",  # s with the first contact open
            "second_open",
            "either_open",
            "impacts",
            "impulse",  # largest (N s)
            "struck",  # energy that impacts took (J)
        )
    ]
)


def empty() -> np.ndarray:
    """Sums of nothing, shape (1,)."""
    sums = np.zeros(1, SUMS)
    clear(sums)
    return sums


@compiled
def clear(sums):
    """Empty the sums."""
    one = sums[0]
    one.lowest = one.first_least = one.second_least = inf
    one.highest = one.first_most = one.second_most = -inf
    one.first_sum = one.second_sum = one.determined = 0.0
    one.peak_velocity = one.time = one.integral = 0.0
    one.stuck_time = one.lifted_time = one.dissipated = one.supplied = 0.0
    one.onsets = one.began_stuck = one.is_stuck = 0.0
    one.first_open = one.second_open = one.either_open = 0.0
    one.impacts = one.impulse = one.struck = 0.0


@inner
def _count_onset(sums, is_stuck):
    """Count a transition from slip to sticking, and the first span if it sticks."""
    if sums.time == 0.0:
        sums.began_stuck = is_stuck
    if is_stuck and not sums.is_stuck:
        sums.onsets += 1.0
    sums.is_stuck = is_stuck


@inlined
def _add_open(sums, weight, mode, p):
    """Add the time for which contacts are open."""
    first, second = opened(mode, p)
    if first:
        sums.first_open += weight
    if second:
        sums.second_open += weight
    if first or second:
        sums.either_open += weight


@inlined
def add_impact(sums, y, mode, place, p):
    """Add an event that is an impact; ``y``: the state before it."""
    strikes, impulse, energy = impact(y, mode, place, p)
    if strikes:
        sums.impacts += 1.0
        sums.impulse = max(sums.impulse, impulse)
        sums.struck += energy


def _pulls(first, second, p):
    """Whether a contact pulls where a real one would open; one that can open never does."""


by_record(
    _pulls,
    lambda fields: (
        (lambda first, second, p: False)
        if provided(opened, fields)
        else (lambda first, second, p: first < 0.0 or second < 0.0)
    ),
)


@inlined
def _add_forces(sums, first, second):
    """Add normal forces (N) that may be extremes."""
    # Most points are none: branches cost less than writing each time.
    if first < sums.first_least:
        sums.first_least = first
    if first > sums.first_most:
        sums.first_most = first
    if second < sums.second_least:
        sums.second_least = second
    if second > sums.second_most:
        sums.second_most = second


@inner
def add_motion(sums, y, weight, mode, p):
    """Add the motion at one point, without forces and energies; ``weight`` (s): of the quadrature node."""
    x, velocity = observed(y, p)
    stuck = sticks(y, mode, p)
    sums.lowest = min(sums.lowest, x)
    sums.highest = max(sums.highest, x)
    sums.peak_velocity = max(sums.peak_velocity, abs(velocity))
    if weight > 0.0:
        _count_onset(sums, 1.0 if stuck else 0.0)
    sums.time += weight
    sums.integral += weight * x
    if stuck:
        sums.stuck_time += weight
    _add_open(sums, weight, mode, p)


@inner
def add(sums, t, y, weight, mode, p):
    """Add one point of the kept window."""
    add_motion(sums, y, weight, mode, p)
    dissipated, supplied, first, second = powers(t, y, mode, p)
    add_powers(sums, weight, dissipated, supplied, first, second, _pulls(first, second, p))


@inlined
def add_powers(sums, weight, dissipated, supplied, first, second, pulls):
    """Add powers (W) and normal forces (N; NaN: not determined) at a point, and whether a contact pulls."""
    sums.dissipated += weight * dissipated
    sums.supplied += weight * supplied
    if first == first:  # NaN: not determined
        _add_forces(sums, first, second)
        sums.first_sum += weight * first
        sums.second_sum += weight * second
        sums.determined += weight
        if pulls:
            sums.lifted_time += weight
