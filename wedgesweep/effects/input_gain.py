"""A gain error of the recorded or stated input; an oscillator's ``input_coupling`` acts in the same way.

Neutral and default: scale = 1.
"""

from wedgesweep.compiled import inlined
from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("u -> scale u",)

EFFECT = Effect(
    name="input_gain",
    family="sensor",
    branch=EXPERIMENTAL,
    meaning="a gain error of the input",
    quantities=(Quantity("scale", 1.0, "what acts over what was recorded", above=0.0, search=(0.5, 2.0)),),
    extends=("scale",),
)
LINEAR = True


@inlined
def base_displacement(u, t, p):
    """Displacement of the base (m)."""
    return p.input_gain.scale * u


@inlined
def base_velocity(u1, t, p):
    """Velocity of the base (m/s)."""
    return p.input_gain.scale * u1


@inlined
def base_acceleration(u2, t, p):
    """Acceleration of the base (m/s^2)."""
    return p.input_gain.scale * u2


@inlined
def input_force(force, t, p):
    """Force on the mass (N)."""
    return p.input_gain.scale * force
