"""Static friction that grows with the time at rest (Dieterich, 1972; Rabinowicz, 1958).

It grows on both faces; t_stuck is the time since the column face last slipped: |v_c| > v_t, or under the
Coulomb law z' != 0. A run begins with t_stuck = 0; a steady response without slip, whose t_stuck grows for
ever, is the one after 100 periods at rest.
Neutral and default: rate = 0. Time must be given.
"""

from math import log1p, nan

import numpy as np

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.effects.states import TIME, set_state, state
from wedgesweep.quantity import Quantity

EQUATIONS = ("mu_s -> mu_s + rate ln(1 + t_stuck/time)",)
REMARK = "Under Coulomb's law friction lets go at $mu_d + rate ln(1 + t_stuck/time)$."

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


STATES = (TIME,)


time_at_rest = state("ageing", 0)
_set_time_at_rest = set_state("ageing", 0)


@term("ageing", off="False")
def acts(p):
    """Whether the faces age."""
    return p.ageing.rate > 0.0


@inlined
def static(mu, clock, y, p):
    """Static coefficient; ``clock``: whether the time at rest runs."""
    if not (clock and acts(p)):
        return mu
    return mu + p.ageing.rate * log1p(time_at_rest(y, p) / p.ageing.time)


@inlined
def rates(column_slip, acceleration, mode, y, p):
    """Rate of the time at rest."""
    return (1.0 if mode.clock and acts(p) else 0.0,)


@term("ageing", off="y")
def rejuvenated(y, p):
    """The state after a slip."""
    return _set_time_at_rest(y, 0.0, p)


def bound(mu: float, p: np.void) -> float:
    """Largest coefficient: none is known, as the time at rest has no end."""
    return nan if p["ageing"]["rate"] > 0.0 else mu
