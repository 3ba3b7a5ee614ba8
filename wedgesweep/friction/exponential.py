"""Exponential friction (the paper's Eq. 3): beyond the ramp it falls slowly with velocity.

The paper prints v^(-0.1), whose value depends on the unit of v. Its program works in mm, so that the unit is
1 mm/s unless another one is given; in m/s friction would be twice as large.
"""

from math import nan

import numpy as np

from wedgesweep.compiled import inlined

EQUATIONS = (
    "mu = mu_s v/v_t  for |v| <= v_t",
    "mu = mu_d sign(v) (|v|/velocity_unit)^velocity_exponent  for |v| > v_t",
)
SET_VALUED = False

# A trial step of an integrator may look a little past the end of its branch, where the power law
# would run to infinity: below this share of v_t it is continued flat. No solution gets there.
FLAT_BELOW = 0.5


@inlined
def static(p):
    """Coefficient at the end of the ramp."""
    return p.friction.mu_s


@inlined
def sliding(speed, p):
    """Coefficient beyond the ramp, at a speed (m/s)."""
    slowest = FLAT_BELOW * p.friction.v_t
    return p.friction.mu_d * (max(speed, slowest) / p.friction.unit) ** p.friction.exponent


@inlined
def exponent(p):
    """Exponent of ``sliding`` as a power of the speed."""
    return p.friction.exponent


def bound(p: np.void) -> float:
    """Largest coefficient; NaN: a positive exponent has none."""
    own = p["friction"]
    if own["exponent"] > 0.0:
        return nan
    return max(own["mu_s"], own["mu_d"] * (own["v_t"] / own["unit"]) ** own["exponent"])
