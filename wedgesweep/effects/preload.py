"""More preload of each wedge spring than the model's.

Neutral and default: force = 0.
"""

import numpy as np

from wedgesweep.effects.base import NUMERICAL, SUSPENSION, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("F_w0 -> F_w0 + force",)

EFFECT = Effect(
    name="preload",
    family="parameters",
    branch=NUMERICAL,
    systems=(SUSPENSION,),
    meaning="more force of each wedge spring",
    quantities=(
        Quantity("force_N", 0.0, "added to the force of each wedge spring at z = 0", search=(-5.0, 30.0)),
    ),
)


def adjust(p: np.void, force: float) -> None:
    """Change the numbers of the model in a parameter record; omega_n stays the nominal one."""
    p["suspension"]["wedge_preload"] += force
