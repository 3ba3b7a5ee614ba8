"""Columns that yield sideways: one more degree of freedom, the way Q outward.

    M_q Q'' = (N_c n_c + mu_c |N_c| t_c).e_x - k Q - 2 damping_ratio sqrt(k M_q) Q'

The wedge follows: (w - Q e_x).n_c = 0; slip on the column is relative to it. Q starts at its static
place. Under the Coulomb law the faces are regularised: mu_d |v|/v_t up to v_t = 1e-3 mm/s.
Neutral: the limit of infinite stiffness; off where the table is absent (0 in the record).
Default: mass = 0.23 kg and damping_ratio = 0.03, neither fitted; stiffness must be given.
"""

from math import nan

from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="column_compliance",
    family="two-dimensional",
    branch=EXPERIMENTAL,
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
        Quantity("mass_kg", 0.23, "mass of a column that moves, M_q", above=0.0),
        Quantity("damping_ratio", 0.03, "damping of a column alone", minimum=0.0),
    ),
    extends=("stiffness",),
)
