"""Coulomb's law (the paper's Eq. 1), set-valued at rest: there the face sticks."""

import numpy as np

from wedgesweep.compiled import inlined

EQUATIONS = ("mu = mu_d sign(v)  for v != 0", "-mu_d <= mu <= mu_d  for v = 0")
SET_VALUED = True


@inlined
def static(p):
    """Coefficient at which friction lets go."""
    return p.friction.mu_d


@inlined
def sliding(speed, p):
    """Coefficient of slip."""
    return p.friction.mu_d


@inlined
def exponent(p):
    """``sliding`` does not depend on the speed."""
    return 0.0


def bound(p: np.void) -> float:
    """Largest coefficient."""
    return p["friction"]["mu_d"]
