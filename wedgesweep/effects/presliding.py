"""Elastic creep of the column face before it slips (Dahl, 1968).

    mu = mu_d b                      on the column face, for every law; the bolster face keeps its own
    b' = (v_c/length) (1 - b sign(v_c))

b is the share of the bristles' deflection at which they slip. Neutral: the limit length -> 0 is
set-valued friction on the column face, the base model under no regularised law; off where the table
is absent (0 in the record). Default: none, length must be given.
"""

from math import nan

from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="presliding",
    family="friction-law",
    branch=NUMERICAL,
    meaning="elastic creep of the column face before it slips (Dahl)",
    quantities=(
        Quantity(
            "length_mm",
            nan,
            "slip over which friction builds up",
            above=0.0,
            off=0.0,
            search=(1e-4, 0.5),
            logarithmic=True,
        ),
    ),
    extends=("length",),
)
