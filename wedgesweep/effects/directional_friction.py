"""Friction of another strength up than down, as with worn or machined faces.

    mu -> mu (1 + asymmetry sign(z'))                            on both faces

Neutral and default: asymmetry = 0.
"""

from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="directional_friction",
    family="friction-law",
    branch=NUMERICAL,
    meaning="friction of another strength up than down",
    quantities=(
        Quantity(
            "asymmetry", 0.0, "share more upward, less downward", above=-1.0, below=1.0, search=(-0.5, 0.5)
        ),
    ),
    extends=("asymmetry",),
)
