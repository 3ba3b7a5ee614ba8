"""The side frame rides on a compliant table; data are relative to the side frame.

The input amplitude is the table's. The run starts with the side frame at rest against the table.
Neutral: the limit of infinite frequency; off where the table is absent (0 in the record).
Default: none, both must be given.
"""

from math import nan, pi

import numpy as np

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import EXPERIMENTAL, SUSPENSION, Effect
from wedgesweep.effects.states import LENGTH, VELOCITY, set_state, state
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = (
    "M_sf x_f'' = -k_f (x_f - u) - c_f (x_f' - u') + F_s",
    "k_f = M_sf (2 pi frequency)^2",
    "c_f = 2 damping_ratio sqrt(k_f M_sf)",
    "z = y - x_f",
)
SYMBOLS = {
    "x_f": Meaning("displacement of the side frame", "m"),
    "u": Meaning("displacement of the table", "m"),
    "y": Meaning("displacement of the bolster", "m"),
    "k_f": Meaning("stiffness between table and side frame", "N/m"),
    "c_f": Meaning("damping constant between them", "N s/m"),
    "F_s": Meaning("force of the suspension on the side frame, less its static part", "N"),
}

EFFECT = Effect(
    name="fixture_resonance",
    family="excitation",
    branch=EXPERIMENTAL,
    systems=(SUSPENSION,),
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


STATES = (LENGTH, VELOCITY)
# Numbers that follow from the others: of the side frame on its table (N/m, N s/m).
DERIVED = ("stiffness", "damping")


deflection = state("fixture_resonance", 0)
velocity = state("fixture_resonance", 1)
with_velocity = set_state("fixture_resonance", 1)
_with_deflection = set_state("fixture_resonance", 0)


def prepare(p: np.void) -> None:
    """Fill in what follows from the other numbers."""
    own, mass = p["fixture_resonance"], p["suspension"]["side_frame_mass"]
    natural = 2.0 * pi * own["frequency"]
    own["stiffness"] = mass * natural**2
    own["damping"] = 2.0 * own["damping_ratio"] * mass * natural


@term("fixture_resonance", off="False")
def acts(p):
    """Whether the side frame moves against its table."""
    return p.fixture_resonance.stiffness > 0.0


@term("fixture_resonance", off="0.0")
def force(y, p):
    """Force of the table on the side frame (N, up positive)."""
    return -p.fixture_resonance.stiffness * deflection(y, p) - p.fixture_resonance.damping * velocity(y, p)


@inlined
def rates(column_slip, acceleration, mode, y, p):
    """Rates of deflection and velocity of the side frame against its table."""
    return (velocity(y, p), acceleration.frame)


@inlined
def power(velocity_of_mass, y, p):
    """Power (W) that the damper of the table takes."""
    return p.fixture_resonance.damping * velocity(y, p) ** 2


@inlined
def later(y, moment, acceleration, p):
    """The state with the side frame a moment (s) later, at a constant acceleration against its table."""
    way = deflection(y, p) + moment * (velocity(y, p) + 0.5 * moment * acceleration)
    return with_velocity(_with_deflection(y, way, p), velocity(y, p) + moment * acceleration, p)
