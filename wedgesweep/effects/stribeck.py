"""Friction that falls from its static value as slip gets faster (Stribeck, 1902).

v is each face's own slip velocity. The form is that of Bo and Pavelescu (1982) with exponent 1.
Neutral: the limit velocity -> 0 with peak = 0; off where the table is absent (0 in the record).
Default: peak = 0; velocity must be given.
"""

from math import exp, nan

import numpy as np

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = (
    "mu = (mu_s + peak) v/v_t  for |v| <= v_t",
    "mu = mu_0 + sign(v) (mu_s - mu_d + peak) exp(-(|v| - v_t)/velocity)  for |v| > v_t",
)
SYMBOLS = {
    "mu_0": Meaning("coefficient of the model's friction law"),
}
REMARK = "Under a set-valued law $v_t = 0$, and friction lets go at $mu_s + peak$."

EFFECT = Effect(
    name="stribeck",
    family="friction-law",
    branch=NUMERICAL,
    meaning="friction that falls from its static value with velocity",
    quantities=(
        Quantity("peak", 0.0, "added to mu_s", minimum=0.0, search=(0.0, 0.5)),
        Quantity(
            "velocity_mm_per_s",
            nan,
            "velocity over which friction falls",
            above=0.0,
            off=0.0,
            search=(0.1, 100.0),
            logarithmic=True,
        ),
    ),
    extends=("velocity",),
)


LINEAR = True  # but for friction that depends on velocity
# A trial step may look past the end of a branch, where friction that falls with velocity would run away.
FLAT_BELOW = -1.0


@term("stribeck", off="False")
def acts(p):
    """Whether friction falls with velocity."""
    return p.stribeck.velocity > 0.0


@inlined
def static(mu, clock, y, p):
    """Static coefficient."""
    return p.friction.mu_s + p.stribeck.peak if acts(p) else mu


@term("stribeck", off="0.0")
def excess(speed, p):
    """Coefficient above the threshold velocity less that of the law."""
    if not acts(p):
        return 0.0
    threshold = 0.0 if p.friction.set_valued else p.friction.v_t
    beyond = max((speed - threshold) / p.stribeck.velocity, FLAT_BELOW)
    return (p.friction.mu_s - p.friction.mu_d + p.stribeck.peak) * exp(-beyond)


@term("stribeck", off="0.0")
def decay(p):
    """Relative change of ``excess`` by the speed (s/m)."""
    return -1.0 / p.stribeck.velocity if acts(p) else 0.0


@inlined
def sliding(mu, speed, p):
    """Coefficient above the threshold velocity, from that of the law."""
    return mu + excess(speed, p)


def bound(mu: float, p: np.void) -> float:
    """Largest coefficient."""
    if p["stribeck"]["velocity"] == 0.0:
        return mu
    return max(mu, p["friction"]["mu_s"] + p["stribeck"]["peak"])
