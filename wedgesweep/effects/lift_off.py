"""Contacts that only press: both faces of a wedge may lift off, fall back and hit.

The mechanics stand in systems/suspension/unilateral; ``joints = "unilateral"`` is the same.
Neutral: none, the joints hold; off where the table is absent (-1 in the record). Default: restitution = 0.
"""

from wedgesweep.effects.base import NUMERICAL, SUSPENSION, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

NAME = "lift_off"

EQUATIONS = (
    "N_c >= 0,  g_c >= 0,  N_c g_c = 0",
    "N_b >= 0,  g_b >= 0,  N_b g_b = 0",
    "w = -restitution w_0",
)
SYMBOLS = {
    "g_c": Meaning("gap at the column face", "m"),
    "g_b": Meaning("gap at the bolster face", "m"),
    "w_0": Meaning("rate at which a gap closes, before the impact", "m/s"),
    "w": Meaning("rate of that gap after the impact", "m/s"),
}
REMARK = "In an impact Coulomb friction acts in the impulse (Moreau's law)."

EFFECT = Effect(
    name=NAME,
    family="contact",
    branch=NUMERICAL,
    systems=(SUSPENSION,),
    meaning="wedges that lift off their faces, fall back and hit",
    quantities=(
        Quantity(
            "restitution",
            0.0,
            "coefficient of restitution of impacts",
            minimum=0.0,
            below=1.0,
            off=-1.0,
            search=(0.0, 0.95),
        ),
    ),
    extends=("restitution",),
)
LINEAR = True  # while its contacts are closed

# Effects with mechanics of their own that go with it.
GO_WITH = (
    *("viscous_damping", "directional_damping", "quadratic_drag", "cubic_stiffness", "end_stop", "backlash"),
    *("stribeck", "input_distortion", "stray_vibration", "fixture_resonance"),
)
