"""Damping that grows with the square of the velocity: flow through an orifice, drag.

Neutral and default: coefficient = 0.
"""

from wedgesweep.compiled import inlined
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("R = -coefficient |z'| z'",)

EFFECT = Effect(
    name="quadratic_drag",
    family="missing-force",
    branch=NUMERICAL,
    meaning="damping that grows with the square of the velocity",
    quantities=(
        Quantity("coefficient_N_s2_per_m2", 0.0, "drag coefficient", minimum=0.0, search=(0.0, 2000.0)),
    ),
    extends=("coefficient",),
)


@inlined
def damping(velocity, y, p):
    """Force on the mass (N, up positive) at z' (m/s)."""
    return -p.quadratic_drag.coefficient * abs(velocity) * velocity
