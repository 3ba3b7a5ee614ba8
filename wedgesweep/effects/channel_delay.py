"""A late channel: the force of a loop against its displacement, a response against the recorded input.

Neutral and default: time = 0.
"""

from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = ("t_m = t + time",)
SYMBOLS = {"t_m": Meaning("time at which the channel shows what it had at t", "s")}

EFFECT = Effect(
    name="channel_delay",
    family="sensor",
    branch=EXPERIMENTAL,
    meaning="delay between the channels",
    quantities=(Quantity("time_s", 0.0, "time by which force or response is late", search=(-0.01, 0.01)),),
)
NAME = EFFECT.name
