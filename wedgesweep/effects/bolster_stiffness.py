"""Another stiffness under the bolster than the model's.

Neutral and default: scale = 1. omega_n stays that of the nominal suspension.
"""

import numpy as np

from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("k_b -> scale k_b",)

EFFECT = Effect(
    name="bolster_stiffness",
    family="parameters",
    branch=NUMERICAL,
    meaning="a different stiffness under the {mass}",
    quantities=(Quantity("scale", 1.0, "factor of k_b", above=0.0, search=(0.5, 2.0)),),
)


def adjust(p: np.void, scale: float) -> None:
    """Change the numbers of the model in a parameter record; omega_n stays the nominal one."""
    p["suspension"]["bolster_spring"] *= scale
