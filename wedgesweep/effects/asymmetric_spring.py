"""A spring that is stiffer to one side, as between two unlike springs or on a bushing with one stop.

z is counted from where the spring is relaxed. Neutral and default: asymmetry = 0.
"""

from wedgesweep.compiled import inlined
from wedgesweep.effects.base import NUMERICAL, OSCILLATOR, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("R = -asymmetry k |z|",)

EFFECT = Effect(
    name="asymmetric_spring",
    family="missing-force",
    branch=NUMERICAL,
    systems=(OSCILLATOR,),
    of_loops=True,
    meaning="a spring under the {mass} that is stiffer to one side",
    quantities=(
        Quantity(
            "asymmetry",
            0.0,
            "half the difference of the stiffnesses to both sides over the mean",
            minimum=-1.0,
            maximum=1.0,
            search=(-0.9, 0.9),
        ),
    ),
    extends=("asymmetry",),
)


@inlined
def force_on_mass(z, velocity, y, p):
    """Force on the mass (N) at the elongation z (m) of the spring."""
    return -p.asymmetric_spring.asymmetry * p.oscillator.spring * abs(z)
