"""Slip out of the plane: friction of both faces shares itself between both directions.

For V <= v_t the share in the plane is the base law's mu_s v/v_t. A column face under ``presliding`` keeps its
bristle. Under the Coulomb law the faces are regularised: mu_d V/v_t up to v_t = 1e-3 mm/s.
Neutral and default: velocity = 0. Default: phase = 0. Half a turn of the phase changes nothing: a fit looks
for it between -90 and 90 degrees.
"""

from math import cos, hypot, sin

from wedgesweep.compiled import term
from wedgesweep.effects.base import NUMERICAL, SUSPENSION, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = ("V = sqrt(v^2 + (velocity cos(omega t + phase))^2)", "mu -> mu(V) v/V")
SYMBOLS = {
    "V": Meaning("magnitude of the slip velocity of a face in both directions", "m/s"),
}

EFFECT = Effect(
    name="cross_slip",
    family="two-dimensional",
    branch=NUMERICAL,
    systems=(SUSPENSION,),
    meaning="slip out of the plane of both faces, at the input frequency",
    quantities=(
        Quantity(
            "velocity_mm_per_s",
            0.0,
            "amplitude of the slip velocity out of the plane",
            minimum=0.0,
            search=(0.1, 200.0),
            logarithmic=True,
        ),
        Quantity("phase_deg", 0.0, "lead over the velocity of the input", search=(-90.0, 90.0)),
    ),
    extends=("velocity",),
)


# Under the Coulomb law the faces could stick one at a time.
REGULARISES = True


@term("cross_slip", off="False")
def acts(p):
    """Whether the faces slip out of the plane."""
    return p.cross_slip.velocity != 0.0


@term("cross_slip", off="0.0")
def velocity(t, p):
    """Slip velocity (m/s) of both faces out of the plane."""
    if p.cross_slip.velocity == 0.0:
        return 0.0
    return p.cross_slip.velocity * cos(p.input.omega * t + p.cross_slip.phase)


@term("cross_slip", off="0.0")
def acceleration(t, p):
    """Its rate (m/s^2)."""
    return -p.cross_slip.velocity * p.input.omega * sin(p.input.omega * t + p.cross_slip.phase)


@term("cross_slip", off="slip")
def speed(slip, t, p):
    """Measure of slip of a face (m/s): its velocity in the plane, or the magnitude of both."""
    return hypot(slip, velocity(t, p)) if acts(p) else slip
