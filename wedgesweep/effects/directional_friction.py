"""Friction of another strength up than down, as with worn or machined faces, on both faces.

Neutral and default: asymmetry = 0.
"""

import numpy as np

from wedgesweep.compiled import term
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("mu -> mu (1 + asymmetry sign(v_z))",)

EFFECT = Effect(
    name="directional_friction",
    family="friction-law",
    branch=NUMERICAL,
    meaning="friction that is stronger in one direction than in the other",
    quantities=(
        Quantity(
            "asymmetry", 0.0, "share more upward, less downward", above=-1.0, below=1.0, search=(-0.5, 0.5)
        ),
    ),
    extends=("asymmetry",),
)
LINEAR = True


@term("directional_friction", off="False")
def acts(p):
    """Whether friction depends on the direction."""
    return p.directional_friction.asymmetry != 0.0


@term("directional_friction", off="1.0")
def factor(direction, p):
    """Factor of both coefficients; ``direction`` is the sign of z'."""
    return 1.0 + p.directional_friction.asymmetry * direction


def bound(mu: float, p: np.void) -> float:
    """Largest coefficient."""
    return mu * (1.0 + abs(p["directional_friction"]["asymmetry"]))
