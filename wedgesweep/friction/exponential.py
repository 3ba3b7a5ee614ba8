"""Exponential friction (the paper's Eq. 3): beyond the ramp it falls slowly with velocity.

    mu = mu_s v / v_t                               for |v| <= v_t  (branch 0)
    mu = mu_d sign(v) (|v| / v_t)^exponent          for |v| >  v_t  (branch -1 or 1)

The paper prints v^(-0.1), which has a meaning only for v in units of v_t.
"""

from wedgesweep.compiled import compiled, inlined

SET_VALUED = False

# A trial step of an integrator may look a little past the end of its branch, where the power law
# would run to infinity: below this share of v_t it is continued flat. No solution gets there.
FLAT_BELOW = 0.5


@inlined
def coefficient(velocity, branch, p):
    """Signed coefficient of friction on a branch of the law."""
    if branch == 0:
        return p.static * velocity / p.threshold_velocity
    speed = max(branch * velocity / p.threshold_velocity, FLAT_BELOW)
    return branch * p.dynamic * speed**p.velocity_exponent


@compiled
def slope(velocity, branch, p):
    """Derivative of ``coefficient`` with respect to the slip velocity (s/m)."""
    if branch == 0:
        return p.static / p.threshold_velocity
    speed = branch * velocity / p.threshold_velocity
    if speed < FLAT_BELOW:
        return 0.0
    return p.dynamic * p.velocity_exponent * speed ** (p.velocity_exponent - 1.0) / p.threshold_velocity
