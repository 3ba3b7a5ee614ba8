"""Another mass of the bolster than the model's; its weight goes with it.

Neutral and default: scale = 1. omega_n stays that of the nominal suspension.
"""

import numpy as np

from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("M_b -> scale M_b",)

EFFECT = Effect(
    name="bolster_mass",
    family="parameters",
    branch=NUMERICAL,
    meaning="a different mass of the {body} (and weight)",
    quantities=(Quantity("scale", 1.0, "factor of M_b", above=0.0, search=(0.5, 2.0)),),
)


def adjust(p: np.void, scale: float) -> None:
    """Change the numbers of the model in a parameter record; omega_n stays the nominal one."""
    p["suspension"]["bolster_mass"] *= scale
