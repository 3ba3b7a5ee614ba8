"""A gain error of the force channel of loops.

Neutral and default: scale = 1.
"""

from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = ("F_m = scale F",)
SYMBOLS = {
    "F": Meaning("force on the mass", "N"),
    "F_m": Meaning("force that its channel shows", "N"),
}

EFFECT = Effect(
    name="force_gain",
    family="sensor",
    branch=EXPERIMENTAL,
    meaning="gain error of the force channel",
    quantities=(Quantity("scale", 1.0, "factor of the force", above=0.0, search=(0.5, 2.0)),),
)
