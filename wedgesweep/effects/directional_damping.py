"""Viscous damping that differs by direction, as between bump and rebound of a damper.

    R = -coefficient (1 + asymmetry sign(z')) z'     on the mass

Neutral and default: coefficient = 0, asymmetry = 0.
"""

from wedgesweep.compiled import inlined
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="directional_damping",
    family="missing-force",
    branch=NUMERICAL,
    meaning="viscous damping that differs by direction",
    quantities=(
        Quantity("coefficient_N_s_per_m", 0.0, "mean coefficient", minimum=0.0, search=(0.0, 100.0)),
        Quantity(
            "asymmetry",
            0.0,
            "half the difference of both directions over the mean",
            minimum=-1.0,
            maximum=1.0,
            search=(-1.0, 1.0),
        ),
    ),
    extends=("coefficient",),
    contains=("viscous_damping",),
)


@inlined
def force_on_mass(z, velocity, y, p):
    """Force on the mass (N, up positive) at z (m) and z' (m/s)."""
    own = p.directional_damping
    return -own.coefficient * (velocity + own.asymmetry * abs(velocity))


@inlined
def power(velocity, y, p):
    """Power (W) that the damper takes."""
    return -force_on_mass(0.0, velocity, y, p) * velocity
