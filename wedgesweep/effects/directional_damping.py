"""Viscous damping that differs by direction, as between bump and rebound of a damper.

The model's own damper is an oscillator's ``damping_N_s_per_m``; a suspension has none. The asymmetry is that
of all viscous damping. Neutral and default: coefficient = 0, asymmetry = 0.
"""

from collections.abc import Mapping
from typing import Any

from wedgesweep.compiled import by_record, expression_of, inlined
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = ("R + R_0 = -(coefficient + c_0) (1 + asymmetry sign(z')) z'", "R_0 = -c_0 z'")
SYMBOLS = {
    "c_0": Meaning("damping constant of the model's own damper, 0 without one", "N s/m"),
    "R_0": Meaning("force of that damper", "N"),
}

ASYMMETRY = Quantity(
    "asymmetry",
    0.0,
    "half the difference of both directions over the mean",
    minimum=-1.0,
    maximum=1.0,
    search=(-1.0, 1.0),
)

EFFECT = Effect(
    name="directional_damping",
    family="missing-force",
    branch=NUMERICAL,
    meaning="viscous damping that differs by direction",
    quantities=(
        Quantity(
            "coefficient_N_s_per_m",
            0.0,
            "coefficient added to the model's, mean of both directions",
            minimum=0.0,
            search=(0.0, 100.0),
        ),
        ASYMMETRY,
    ),
    extends=("coefficient", "asymmetry"),
    contains=("viscous_damping",),
)


def _damper(p):
    """Coefficient (N s/m) of the damper that the model itself has."""


def _of_system(fields: Mapping[str, Any]) -> Any:
    return expression_of(["p"], "p.oscillator.damping" if "oscillator" in fields else "0.0")


by_record(_damper, _of_system)


@inlined
def damping(velocity, y, p):
    """Force on the mass (N, up positive) at z' (m/s)."""
    own = p.directional_damping
    return -own.coefficient * velocity - (own.coefficient + _damper(p)) * own.asymmetry * abs(velocity)
