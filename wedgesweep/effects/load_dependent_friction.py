"""Coefficients of friction that depend on the normal force (Hertzian contacts: exponent 1/3).

    mu -> mu (|N|/reference)^(-exponent)                         on both faces, each with its own N

N and mu are solved together. Neutral and default: exponent = 0. Default: reference = 1 N, not fitted.
"""

from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="load_dependent_friction",
    family="friction-law",
    branch=NUMERICAL,
    meaning="coefficients of friction that depend on the normal force",
    quantities=(
        Quantity(
            "exponent",
            0.0,
            "power by which the coefficients fall with load",
            minimum=-1.0,
            below=1.0,
            search=(-0.5, 0.6),
        ),
        Quantity(
            "reference_N", 1.0, "normal force at which the coefficients are the nominal ones", above=0.0
        ),
    ),
    extends=("exponent",),
)
