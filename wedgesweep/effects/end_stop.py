"""Springs that the bolster meets at the ends of its travel.

    R = -stiffness (x - clearance)   for x >  clearance         on the bolster, x from its rest position
    R = -stiffness (x + clearance)   for x < -clearance

Neutral: the limit of infinite clearance, and stiffness = 0; off where the table is absent.
Default: none, both must be given.
"""

from math import nan

from wedgesweep.compiled import inlined
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="end_stop",
    family="missing-force",
    branch=NUMERICAL,
    meaning="springs at the ends of the bolster's travel",
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


@inlined
def force(x, stop, p):
    """Force on the bolster (N, up positive) in contact with the upper (1), the lower (-1) or no stop (0)."""
    if stop == 0:
        return 0.0
    return -p.end_stop_stiffness * (x - stop * p.end_stop_clearance)
