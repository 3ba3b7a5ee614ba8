"""The side frame rides on a compliant table; data are relative to the side frame.

    M_sf x_f'' = -k_f (x_f - u) - c_f (x_f' - u') + force of the suspension, less its static part
    k_f = M_sf (2 pi frequency)^2,  c_f = 2 damping_ratio sqrt(k_f M_sf),  z = y - x_f

u and the input amplitude are the table's. The run starts with the side frame at rest against the table.
Neutral: the limit of infinite frequency; off where the table is absent (0 in the record).
Default: none, both must be given.
"""

from math import nan

from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="fixture_resonance",
    family="excitation",
    branch=EXPERIMENTAL,
    meaning="a side frame on a compliant table",
    quantities=(
        Quantity(
            "frequency_hz",
            nan,
            "natural frequency of the side frame alone on the table",
            above=0.0,
            off=0.0,
            search=(6.0, 400.0),
            logarithmic=True,
        ),
        Quantity(
            "damping_ratio",
            nan,
            "damping of the side frame alone on the table",
            minimum=0.0,
            off=0.0,
            search=(0.003, 0.7),
            logarithmic=True,
        ),
    ),
    extends=("frequency",),
)
