"""Play of the spring: about its rest position the spring's force does not change.

It takes back what the spring itself gains in the play. Neutral and default: clearance = 0.
"""

from wedgesweep.compiled import term
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("R = k_b z_r  for |z_r| <= clearance", "R = k_b clearance sign(z_r)  for |z_r| > clearance")

EFFECT = Effect(
    name="backlash",
    family="missing-force",
    branch=NUMERICAL,
    meaning="play of the {mass}'s spring about its rest position",
    quantities=(
        Quantity(
            "clearance_mm",
            0.0,
            "play either way from the rest position",
            minimum=0.0,
            search=(1e-4, 1.0),
            logarithmic=True,
        ),
    ),
    extends=("clearance",),
)
LINEAR = True


@term("backlash", off="False")
def acts(p):
    """Whether there is play."""
    return p.backlash.clearance > 0.0


@term("backlash", off="0.0")
def clearance(p):
    """Play either way (m)."""
    return p.backlash.clearance


@term("backlash", off="0.0")
def force(x, side, spring, p):
    """Force on the mass (N, up positive) within the play (0), or beyond it upward (1) or downward (-1).

    ``spring``: stiffness (N/m) of the spring that has it.
    """
    return spring * (side * p.backlash.clearance if side else x)
