"""LuGre friction: bristles that bend before they slip (Canudas de Wit, Olsson, Astrom and Lischinsky, 1995).

    T = sigma_0 z + sigma_1 z' + sigma_2 v
    z' = v - sigma_0 |v| z / g(v),     g(v) = N (mu_d + (mu_s - mu_d) exp(-(v/v_t)^2))

For oscillators only: the bristles are in lugre_bristles.py. Their stiffness sigma_0, their damping sigma_1
and the viscous part sigma_2 are keys of [oscillator]. There is no true sticking: slip below v_t counts as
stuck.
"""

from math import exp

import numpy as np

from wedgesweep.compiled import inlined

SET_VALUED = False


@inlined
def static(p):
    """Coefficient at the lowest speed."""
    return p.friction.mu_s


@inlined
def sliding(speed, p):
    """Coefficient of steady slip at a speed (m/s), without the viscous part."""
    share = speed / p.friction.v_t
    return p.friction.mu_d + (p.friction.mu_s - p.friction.mu_d) * exp(-share * share)


@inlined
def constant(p):
    """Whether ``sliding`` does not depend on the speed."""
    return False


def bound(p: np.void) -> float:
    """Largest coefficient."""
    return max(p["friction"]["mu_s"], p["friction"]["mu_d"])
