"""Another stiffness under the wedges than the model's.

Neutral and default: scale = 1.
"""

import numpy as np

from wedgesweep.effects.base import NUMERICAL, SUSPENSION, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("k_w -> scale k_w",)

EFFECT = Effect(
    name="wedge_stiffness",
    family="parameters",
    branch=NUMERICAL,
    systems=(SUSPENSION,),
    meaning="a different stiffness under the wedges",
    quantities=(Quantity("scale", 1.0, "factor of k_w", above=0.0, search=(0.5, 2.0)),),
)


def adjust(p: np.void, scale: float) -> None:
    """Change the numbers of the model in a parameter record; omega_n stays the nominal one."""
    p["suspension"]["wedge_spring"] *= scale
