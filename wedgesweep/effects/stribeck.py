"""Friction that falls from its static value as slip gets faster (Stribeck, 1902).

    mu = (mu_s + peak) v/v_t                                                     for |v| <= v_t
    mu = base law + sign(v) (mu_s - mu_d + peak) exp(-(|v| - v_t)/velocity)      for |v| >  v_t

v is each face's own slip velocity. Under the Coulomb law v_t = 0, and friction lets go at mu_s + peak.
The form is that of Bo and Pavelescu (1982) with exponent 1.
Neutral: the limit velocity -> 0 with peak = 0; off where the table is absent (0 in the record).
Default: peak = 0; velocity must be given.
"""

from math import nan

from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="stribeck",
    family="friction-law",
    branch=NUMERICAL,
    meaning="friction that falls from its static value with velocity",
    quantities=(
        Quantity("peak", 0.0, "added to mu_s", minimum=0.0, search=(0.0, 0.5)),
        Quantity(
            "velocity_mm_per_s",
            nan,
            "velocity over which friction falls",
            above=0.0,
            off=0.0,
            search=(0.1, 100.0),
            logarithmic=True,
        ),
    ),
    extends=("velocity",),
)
