"""Columns that yield sideways: one more degree of freedom, the displacement Q outward.

The wedge follows the column. Q starts at its static place. Under the Coulomb law the faces are regularised:
mu_d |v|/v_t up to v_t = 1e-3 mm/s.
Neutral: the limit of infinite stiffness; off where the table is absent (0 in the record).
Default: mass = half the side frame's (0.23 kg on the bench) and damping_ratio = 0.03, neither fitted;
stiffness must be given.
"""

from math import nan, sqrt

import numpy as np

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import EXPERIMENTAL, SUSPENSION, Effect
from wedgesweep.effects.states import LENGTH, VELOCITY, place_of, state
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = (
    "mass Q'' = (N_c n_c + mu_c |N_c| t_c) . e_x - stiffness Q - 2 damping_ratio sqrt(stiffness mass) Q'",
    "(w - Q e_x) . n_c = 0",
)
SYMBOLS = {
    "Q": Meaning("displacement of a column outward", "m"),
    "w": Meaning("displacement of the wedge, a vector", "m"),
}
REMARK = "Slip on the column is relative to it."

EFFECT = Effect(
    name="column_compliance",
    family="two-dimensional",
    branch=EXPERIMENTAL,
    systems=(SUSPENSION,),
    meaning="columns that yield sideways",
    quantities=(
        Quantity(
            "stiffness_N_per_mm",
            nan,
            "lateral stiffness of a column, k",
            above=0.0,
            off=0.0,
            search=(2.0, 5000.0),
            logarithmic=True,
        ),
        Quantity(
            "mass_kg", 0.0, "mass of a column that moves, M_q; 0: half of the side frame's", minimum=0.0
        ),
        Quantity("damping_ratio", 0.03, "damping of a column alone", minimum=0.0),
    ),
    extends=("stiffness",),
)


STATES = (LENGTH, VELOCITY)
# Numbers that follow from the others: place Q of the frictionless equilibrium, damping constant (N s/m).
DERIVED = ("rest", "damping")
# Under the Coulomb law the faces could stick one at a time.
REGULARISES = True


deflection = state("column_compliance", 0)
velocity = state("column_compliance", 1)
velocity_place = place_of("column_compliance", 1)


def prepare(p: np.void) -> None:
    """Fill in what follows from the other numbers."""
    own = p["column_compliance"]
    if own["mass"] == 0.0:
        own["mass"] = 0.5 * p["suspension"]["side_frame_mass"]
    own["damping"] = 2.0 * own["damping_ratio"] * sqrt(own["stiffness"] * own["mass"])


@term("column_compliance", off="False")
def acts(p):
    """Whether the columns yield."""
    return p.column_compliance.stiffness > 0.0


@term("column_compliance", off="0.0")
def displacement(y, p):
    """Q (m) of a column outward, from its place without load."""
    return p.column_compliance.rest + deflection(y, p)


@term("column_compliance", off="0.0")
def force(y, p):
    """Force of spring and damper on a column outward (N)."""
    return -p.column_compliance.stiffness * displacement(y, p) - p.column_compliance.damping * velocity(y, p)


@term("column_compliance", off="0.0")
def stiffness(p):
    """Lateral stiffness of a column (N/m)."""
    return p.column_compliance.stiffness


@term("column_compliance", off="0.0")
def compliance(p):
    """Acceleration of a column per force (1/kg)."""
    return 1.0 / p.column_compliance.mass if acts(p) else 0.0


@inlined
def rates(column_slip, acceleration, mode, y, p):
    """Rates of Q and Q'."""
    return (velocity(y, p), acceleration.column)


@inlined
def power(velocity_of_mass, y, p):
    """Power (W) that the dampers of both columns take."""
    return 2.0 * p.column_compliance.damping * velocity(y, p) ** 2
