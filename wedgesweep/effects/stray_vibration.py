"""A foreign tone in the acceleration of the side frame (or of the table under it).

    u'' -> u'' + acceleration sin(2 pi frequency t + phase)

Its phase is another one in every measurement (``stray_vibration_phase`` of a case, 0 unless set), and
the response is not periodic in the forcing.
Neutral and default: acceleration = 0; frequency must be given.
"""

from math import nan

from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="stray_vibration",
    family="excitation",
    branch=EXPERIMENTAL,
    meaning="a foreign tone in the acceleration of the side frame",
    quantities=(
        Quantity("acceleration_m_per_s2", 0.0, "amplitude of the tone", minimum=0.0, search=(0.0, 20.0)),
        Quantity(
            "frequency_hz",
            nan,
            "frequency of the tone",
            above=0.0,
            off=0.0,
            search=(1.0, 300.0),
            logarithmic=True,
        ),
    ),
    extends=("acceleration",),
)
