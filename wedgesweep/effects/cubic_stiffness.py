"""Bolster springs that stiffen or, with a negative coefficient, soften with travel (Duffing, 1918).

z is counted from the springs' free length. It moves the rest position. Neutral and default: coefficient = 0.
"""

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("R = -coefficient z^3",)

EFFECT = Effect(
    name="cubic_stiffness",
    family="missing-force",
    branch=NUMERICAL,
    meaning="a spring under the {mass} that stiffens or softens with travel",
    quantities=(Quantity("coefficient_N_per_mm3", 0.0, "cubic stiffness, k_3", search=(-1.0, 20.0)),),
    extends=("coefficient",),
)


@inlined
def force_on_mass(z, velocity, y, p):
    """Force on the bolster (N, up positive) at z (m) and z' (m/s)."""
    return -p.cubic_stiffness.coefficient * z * z * z


@term("cubic_stiffness", off="0.0")
def coefficient(p):
    """k_3 (N/m^3), which moves the rest position."""
    return p.cubic_stiffness.coefficient
