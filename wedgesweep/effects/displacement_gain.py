"""A gain error of the displacement channel.

Neutral and default: scale = 1.
"""

from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = ("d_m = scale d",)
SYMBOLS = {
    "d": Meaning("displacement", "m"),
    "d_m": Meaning("displacement that its channel shows", "m"),
}

EFFECT = Effect(
    name="displacement_gain",
    family="sensor",
    branch=EXPERIMENTAL,
    meaning="gain error of the displacement channel",
    quantities=(Quantity("scale", 1.0, "factor of the displacement", above=0.0, search=(0.5, 2.0)),),
)
