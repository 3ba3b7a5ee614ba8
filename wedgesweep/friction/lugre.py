"""LuGre friction: bristles that bend before they slip (Canudas de Wit, Olsson, Astrom and Lischinsky, 1995).

For oscillators only: the bristles are in lugre_bristles.py. Their stiffness sigma_0, their damping sigma_1
and the viscous part sigma_2 are keys of [oscillator]. There is no true sticking: slip below v_t counts as
stuck.
"""

from math import exp, nan

import numpy as np

from wedgesweep.compiled import inlined
from wedgesweep.equations.symbols import Meaning

EQUATIONS = (
    "mu N = sigma_0 b + sigma_1 b' + sigma_2 v",
    "b' = v - sigma_0 |v| b/G",
    "G = N (mu_d + (mu_s - mu_d) exp(-(v/v_t)^2))",
)
SYMBOLS = {
    "b": Meaning("deflection of the bristles", "m"),
    "G": Meaning("friction of steady slip without its viscous part", "N"),
    "sigma_0": Meaning("stiffness of the bristles, bristle_stiffness", "N/m"),
    "sigma_1": Meaning("damping of the bristles, bristle_damping", "N s/m"),
    "sigma_2": Meaning("viscous friction beside them, bristle_viscous", "N s/m"),
}
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
def exponent(p):
    """``sliding`` is no power of the speed."""
    return nan


def bound(p: np.void) -> float:
    """Largest coefficient."""
    return max(p["friction"]["mu_s"], p["friction"]["mu_d"])
