"""Static-dynamic friction (the paper's Eq. 2): a steep ramp up to mu_s, then a drop to mu_d.

mu = mu_s v / v_t             for |v| <= v_t  (branch 0)
mu = mu_d sign(v)             for |v| >  v_t  (branch -1 or 1)
"""

from wedgesweep.compiled import compiled, inlined

SET_VALUED = False


@inlined
def coefficient(velocity, branch, p):
    """Signed coefficient of friction on a branch of the law."""
    if branch == 0:
        return p.static * velocity / p.threshold_velocity
    return branch * p.dynamic


@compiled
def slope(velocity, branch, p):
    """Derivative of ``coefficient`` with respect to the slip velocity (s/m)."""
    if branch == 0:
        return p.static / p.threshold_velocity
    return 0.0
