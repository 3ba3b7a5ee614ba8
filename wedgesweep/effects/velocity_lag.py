"""The velocity channel lags behind the displacement channel: a first-order filter.

Neutral and default: time = 0.
"""

from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = ("time v_m' = d' - v_m",)
SYMBOLS = {
    "d": Meaning("displacement", "m"),
    "v_m": Meaning("velocity that its channel shows", "m/s"),
}

EFFECT = Effect(
    name="velocity_lag",
    family="sensor",
    branch=EXPERIMENTAL,
    meaning="first-order lag of the velocity channel",
    quantities=(Quantity("time_s", 0.0, "time constant of the lag", minimum=0.0, search=(0.0, 0.02)),),
)
