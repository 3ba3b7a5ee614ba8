"""Exponential friction (the paper's Eq. 3): beyond the ramp it falls slowly with velocity.

The paper prints v^(-0.1), which has a meaning only for v in units of v_t.
"""

from math import nan

import numpy as np

from wedgesweep.compiled import inlined

EQUATIONS = (
    "mu = mu_s v/v_t  for |v| <= v_t",
    "mu = mu_d sign(v) (|v|/v_t)^velocity_exponent  for |v| > v_t",
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
    return p.friction.mu_d * max(speed / p.friction.v_t, FLAT_BELOW) ** p.friction.exponent


@inlined
def exponent(p):
    """Exponent of ``sliding`` as a power of the speed."""
    return p.friction.exponent


def bound(p: np.void) -> float:
    """Largest coefficient; NaN: a positive exponent has none."""
    return nan if p["friction"]["exponent"] > 0.0 else max(p["friction"]["mu_s"], p["friction"]["mu_d"])
