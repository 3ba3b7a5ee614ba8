"""Static friction that grows with the time at rest (Dieterich, 1972; Rabinowicz, 1958).

    mu_s -> mu_s + rate ln(1 + t_stuck/time)                     on both faces

t_stuck is the time since the column face last slipped: |v_c| > v_t, or under the Coulomb law z' != 0,
where friction lets go at mu_d + rate ln(1 + t_stuck/time). A run begins with t_stuck = 0; a steady response
without slip, whose t_stuck grows for ever, is the one after 100 periods at rest.
Neutral and default: rate = 0. Time must be given.
"""

from math import nan

from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="ageing",
    family="friction-law",
    branch=NUMERICAL,
    meaning="static friction that grows with the time at rest",
    quantities=(
        Quantity("rate", 0.0, "growth of mu_s per factor e of time", minimum=0.0, search=(0.0, 0.3)),
        Quantity(
            "time_s",
            nan,
            "time at rest from which it grows",
            above=0.0,
            off=1.0,
            search=(1e-4, 1.0),
            logarithmic=True,
        ),
    ),
    extends=("rate",),
)
