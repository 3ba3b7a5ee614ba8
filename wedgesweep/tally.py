"""Running sums over the kept window of a run: all numbers that need no waveform.

A solver adds points as it goes: quadrature nodes with their weights, and points of weight 0 where a
piece begins or ends and where x is extreme.
"""

from math import inf

import numpy as np

from wedgesweep import excitation, friction
from wedgesweep.compiled import compiled
from wedgesweep.contact import acting, held, held_between, stuck
from wedgesweep.effects import guide_friction

TALLY = np.dtype(
    [
        (name, np.float64)
        for name in (
            "lowest",  # x (m)
            "highest",
            "peak_velocity",  # m/s
            "time",  # s
            "integral",  # of x (m s)
            "stuck_time",  # s
            "lifted_time",  # s with a negative normal force
            "normal_force",  # smallest while slipping (N)
            "dissipated",  # J
            "supplied",  # J, by the base
            "onsets",  # of sticking
            "began_stuck",
            "is_stuck",
        )
    ]
)


def empty() -> np.ndarray:
    """A tally of nothing, shape (1,)."""
    tally = np.zeros(1, TALLY)
    tally["lowest"], tally["highest"], tally["normal_force"] = inf, -inf, inf
    return tally


@compiled
def friction_power(velocity, now, contact, p):
    """Power (W) that friction takes from the suspension on all faces."""
    column_slip, bolster_slip = p.column_ratio * velocity, p.bolster_ratio * velocity
    column = friction.coefficient(column_slip, contact.column, p) * abs(now.column) * column_slip
    bolster = friction.coefficient(bolster_slip, contact.bolster, p) * abs(now.bolster)
    guide = guide_friction.force(velocity, contact.guide, p)
    return 2.0 * (column + bolster * bolster_slip) - guide * velocity


@compiled
def _power_at_jump(x, velocity, base_acceleration, contact, p):
    """Power (W) of friction while a jump of the law holds the slip velocity."""
    low, below, high, above, share, _ = held_between(x, velocity, base_acceleration, contact, p)
    lower = friction_power(velocity, below, low, p)
    return share * lower + (1.0 - share) * friction_power(velocity, above, high, p)


@compiled
def count_onset(tally, is_stuck):
    """Follow the sequence of sticking and slipping spans."""
    if tally.time == 0.0:
        tally.began_stuck = is_stuck
    if is_stuck and not tally.is_stuck:
        tally.onsets += 1.0
    tally.is_stuck = is_stuck


@compiled
def add_motion(tally, x, velocity, weight, sticks):
    """Add what one point of the kept window says without its forces."""
    tally.lowest = min(tally.lowest, x)
    tally.highest = max(tally.highest, x)
    tally.peak_velocity = max(tally.peak_velocity, abs(velocity))
    if weight > 0.0:
        count_onset(tally, 1.0 if sticks else 0.0)
    tally.time += weight
    tally.integral += weight * x
    if sticks:
        tally.stuck_time += weight


@compiled
def add(tally, t, x, velocity, weight, contact, p):
    """Add one point of the kept window; ``weight`` (s) as in a quadrature."""
    add_motion(tally, x, velocity, weight, abs(contact.column) != 1)
    if stuck(contact, p):
        return
    base_acceleration = excitation.acceleration(t, p)
    now = acting(x, velocity, base_acceleration, contact, p)
    tally.normal_force = min(tally.normal_force, now.column, now.bolster)
    if now.column < 0.0 or now.bolster < 0.0:
        tally.lifted_time += weight
    moved = p.bolster_mass + 2.0 * p.wedge_mass * p.column_ratio * p.cos_column
    tally.supplied -= weight * moved * base_acceleration * velocity
    if held(contact):
        power = _power_at_jump(x, velocity, base_acceleration, contact, p)
    else:
        power = friction_power(velocity, now, contact, p)
    tally.dissipated += weight * power


@compiled
def add_all(tallies, t, x, velocity, weight, contact, parameters):
    """Add points of one contact, arrays of shape (n,)."""
    for i in range(t.size):
        add(tallies[0], t[i], x[i], velocity[i], weight[i], contact, parameters[0])
