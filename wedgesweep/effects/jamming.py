"""Forces locked into the wedge at rest, which hold it beyond the least sticking of Coulomb's law.

At rest friction on one face is independent of friction on the other, so that a band of base accelerations
admits rest as well as slip (systems/suspension/rest.py). ``locked_in`` chooses within it: 0 breaks away
at the earliest, 1 at the latest. Set-valued friction only: regularised laws have no rest.
Neutral and default: locked_in = 0.
"""

from wedgesweep.effects.base import NUMERICAL, SUSPENSION, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = ("u_1 = u_0 + locked_in (u_2 - u_0)",)
SYMBOLS = {
    "u_0": Meaning("base acceleration at which both faces can begin to slip", "m/s2"),
    "u_1": Meaning("base acceleration at which they do", "m/s2"),
    "u_2": Meaning("last base acceleration under which contact forces allow rest", "m/s2"),
}

NAME = "jamming"

EFFECT = Effect(
    name=NAME,
    family="contact",
    branch=NUMERICAL,
    systems=(SUSPENSION,),
    meaning="wedges that forces locked in at rest hold longer",
    quantities=(
        Quantity(
            "locked_in",
            0.0,
            "share of the band of rest that is held",
            minimum=0.0,
            maximum=1.0,
            search=(0.0, 1.0),
        ),
    ),
    extends=("locked_in",),
    excludes=(
        *("column_compliance", "fixture_resonance", "load_dependent_friction", "directional_friction"),
        "lift_off",
    ),
)
LINEAR = True
