"""Viscous damping between the bolster and the side frame.

Neutral and default: coefficient = 0.
"""

from wedgesweep.compiled import inlined
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("R = -coefficient z'",)

EFFECT = Effect(
    name="viscous_damping",
    family="missing-force",
    branch=NUMERICAL,
    meaning="viscous damping between {mass} and {base}",
    quantities=(
        Quantity("coefficient_N_s_per_m", 0.0, "viscous coefficient", minimum=0.0, search=(0.0, 100.0)),
    ),
    extends=("coefficient",),
)
LINEAR = True


@inlined
def damping(velocity, y, p):
    """Force on the mass (N, up positive) at z' (m/s)."""
    return -p.viscous_damping.coefficient * velocity
