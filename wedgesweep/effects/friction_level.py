"""Another level of friction than the model's, on both faces of the wedges.

Neutral and default: scale = 1.
"""

import numpy as np

from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("mu_s -> scale mu_s", "mu_d -> scale mu_d")

EFFECT = Effect(
    name="friction_level",
    family="parameters",
    branch=NUMERICAL,
    meaning="a different level of friction on the {faces}",
    quantities=(Quantity("scale", 1.0, "factor of mu_s and mu_d", minimum=0.0, search=(0.5, 2.0)),),
)


def adjust(p: np.void, scale: float) -> None:
    """Change the numbers of the model in a parameter record; omega_n stays the nominal one."""
    p["friction"]["mu_s"] *= scale
    p["friction"]["mu_d"] *= scale
