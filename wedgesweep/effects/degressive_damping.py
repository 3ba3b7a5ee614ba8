"""Damping that grows less and less with the velocity, as where the valve of a damper opens, by direction.

Viscous at small velocities, a power of the velocity at large ones; its slope is finite everywhere.
Neutral and default: coefficient = 0. Default: asymmetry = 0, and exponent = 0.5, which is not fitted; the
velocity must be given.
"""

from math import nan

from wedgesweep.compiled import inlined
from wedgesweep.effects.base import NUMERICAL, OSCILLATOR, Effect
from wedgesweep.effects.directional_damping import ASYMMETRY
from wedgesweep.quantity import Quantity

EQUATIONS = ("R = -coefficient (1 + asymmetry sign(z')) z' (1 + |z'|/velocity)^(exponent - 1)",)

EFFECT = Effect(
    name="degressive_damping",
    family="missing-force",
    branch=NUMERICAL,
    systems=(OSCILLATOR,),
    of_loops=True,
    contains=("viscous_damping", "directional_damping"),  # where the velocity is large
    meaning="damping that grows less and less with the velocity",
    quantities=(
        Quantity(
            "coefficient_N_s_per_m",
            0.0,
            "damping constant at small velocities, mean of both directions",
            minimum=0.0,
            search=(0.0, 200.0),
        ),
        Quantity(
            "velocity_mm_per_s",
            nan,
            "velocity beyond which it is a power",
            above=0.0,
            off=1.0,
            search=(1.0, 500.0),
            logarithmic=True,
        ),
        ASYMMETRY,
        Quantity("exponent", 0.5, "the power", minimum=0.0, maximum=1.0),
    ),
    extends=("coefficient",),
)


@inlined
def damping(velocity, y, p):
    """Force on the mass (N) at z' (m/s)."""
    own = p.degressive_damping
    if own.coefficient == 0.0:
        return 0.0
    bent = (1.0 + abs(velocity) / own.velocity) ** (own.exponent - 1.0)
    return -own.coefficient * (velocity + own.asymmetry * abs(velocity)) * bent
