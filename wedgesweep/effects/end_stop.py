"""Springs that the bolster meets at the ends of its travel.

Neutral: the limit of infinite clearance, and stiffness = 0; off where the table is absent.
Default: none, both must be given.
"""

from math import nan

from wedgesweep.compiled import term
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = (
    "R = -stiffness (z_r - clearance)  for z_r > clearance",
    "R = -stiffness (z_r + clearance)  for z_r < -clearance",
)

EFFECT = Effect(
    name="end_stop",
    family="missing-force",
    branch=NUMERICAL,
    meaning="springs at the ends of the {mass}'s travel",
    quantities=(
        Quantity(
            "clearance_mm",
            nan,
            "free travel either way from the rest position",
            minimum=0.0,
            off=0.0,
            search=(0.005, 5.0),
            logarithmic=True,
        ),
        Quantity(
            "stiffness_N_per_mm",
            nan,
            "stiffness of either stop",
            minimum=0.0,
            off=0.0,
            search=(0.5, 2000.0),
            logarithmic=True,
        ),
    ),
    extends=("stiffness",),
)
LINEAR = True


@term("end_stop", off="False")
def acts(p):
    """Whether there are stops."""
    return p.end_stop.stiffness > 0.0


@term("end_stop", off="0.0")
def clearance(p):
    """Free travel either way (m)."""
    return p.end_stop.clearance


@term("end_stop", off="0.0")
def force(x, stop, p):
    """Force on the bolster (N, up positive) in contact with the upper (1), the lower (-1) or no stop (0)."""
    if stop == 0:
        return 0.0
    return -p.end_stop.stiffness * (x - stop * p.end_stop.clearance)
