"""Friction that falls hyperbolically with velocity, as in studies of stick-slip (Leine et al., 1998).

It is set-valued at rest. For oscillators only. v_t is the velocity at which it has fallen to half.
"""

from math import nan

import numpy as np

from wedgesweep.compiled import inlined

EQUATIONS = ("mu = mu_s sign(v)/(1 + |v|/v_t)  for v != 0", "-mu_s <= mu <= mu_s  for v = 0")
SET_VALUED = True

# A trial step may look a little past zero velocity, where this would run to infinity. No solution gets there.
SLOWEST = -0.5


@inlined
def static(p):
    """Coefficient at which friction lets go."""
    return p.friction.mu_s


@inlined
def sliding(speed, p):
    """Coefficient of slip at a speed (m/s)."""
    return p.friction.mu_s / (1.0 + max(speed / p.friction.v_t, SLOWEST))


@inlined
def exponent(p):
    """``sliding`` is no power of the speed."""
    return nan


def bound(p: np.void) -> float:
    """Largest coefficient."""
    return p["friction"]["mu_s"]
