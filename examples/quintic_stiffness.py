"""A hypothesis: springs that stiffen as the fifth power of travel, not as the third.

Neutral and default: force = 0.
"""

from wedgesweep.compiled import inlined
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

# Travel (m) at which the force is given.
TRAVEL = 1e-3

EQUATIONS = ("R = -force (z/z_1)^5",)
SYMBOLS = {"z_1": Meaning("1 mm", "m")}
EFFECT = Effect(
    name="quintic_stiffness",
    family="missing-force",
    branch=NUMERICAL,
    meaning="a spring under the {mass} that stiffens as the fifth power of travel",
    quantities=(Quantity("force_N", 0.0, "force at a travel of 1 mm", search=(-1.0, 20.0)),),
    extends=("force",),
)


@inlined
def force_on_mass(z, velocity, y, p):
    """Force on the mass (N, up positive) at z (m)."""
    return -p.quintic_stiffness.force * (z / TRAVEL) ** 5
