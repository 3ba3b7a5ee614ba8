"""Static-dynamic friction (the paper's Eq. 2): a steep ramp up to mu_s, then a drop to mu_d.

The ramp is branch 0, and slip either way is branch -1 or 1.
"""

import numpy as np

from wedgesweep.compiled import inlined

EQUATIONS = ("mu = mu_s v/v_t  for |v| <= v_t", "mu = mu_d sign(v)  for |v| > v_t")
SET_VALUED = False


@inlined
def static(p):
    """Coefficient at the end of the ramp."""
    return p.friction.mu_s


@inlined
def sliding(speed, p):
    """Coefficient beyond the ramp."""
    return p.friction.mu_d


@inlined
def exponent(p):
    """``sliding`` does not depend on the speed."""
    return 0.0


def bound(p: np.void) -> float:
    """Largest coefficient."""
    return max(p["friction"]["mu_s"], p["friction"]["mu_d"])
