"""Another viscous damper of an oscillator than the model's.

Neutral and default: scale = 1. No diagnosis looks for it, as ``viscous_damping`` beside the model's damper is
the same force; a measurement may declare it uncertain.
"""

from wedgesweep.effects.base import NUMERICAL, OSCILLATOR, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("c -> scale c",)

EFFECT = Effect(
    name="damping_level",
    family="parameters",
    branch=NUMERICAL,
    meaning="a different viscous damper between {mass} and {base}",
    quantities=(Quantity("scale", 1.0, "factor of c", minimum=0.0),),
    systems=(OSCILLATOR,),
)
