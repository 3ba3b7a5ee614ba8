"""Forces of displacement and velocity that are no candidates: an effect from outside the package.

``wedgesweep synthesize --plugin`` hides one of twelve shapes in data. The force on the mass is
-force times a shape of z/displacement and z'/velocity, which reach 1 in the tests.

Neutral and default: force = 0.
"""

from math import exp, pi, sin, tanh

import numpy as np

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

NAMES = (
    "drag of the third power",
    "friction that is larger about one velocity",
    "spring that softens, then stiffens",
    "one-way clutch",
    "friction that is larger about one place",
    "damping that grows with travel",
    "cogging",
    "spring whose stiffness grows with speed",
    "eddy-current brake",
    "bumper on one side",
    "drag of the third power and cogging",
    "eddy-current brake and damping that grows with travel",
)
EQUATIONS = ("R = -force f (z, z')",)
SYMBOLS = {"f": Meaning("one of twelve shapes", "1")}
EFFECT = Effect(
    name="hidden_force",
    family="missing-force",
    branch=NUMERICAL,
    meaning="a force on the {mass} that is no candidate",
    quantities=(
        Quantity("force_N", 0.0, "size of the force"),
        Quantity("shape", 0.0, "which of the shapes"),
        Quantity("displacement_mm", 1.0, "displacement that counts as 1", above=0.0),
        Quantity("velocity_mm_per_s", 1.0, "velocity that counts as 1", above=0.0),
    ),
    extends=("force",),
)


def shape(which: int, z: float, v: float) -> float:
    """Force against motion or displacement over its size, at z and v in units of the largest ones."""
    if which == 0:
        return v**3
    if which == 1:
        return tanh(v / 0.05) * exp(-(((abs(v) - 0.5) / 0.15) ** 2))
    if which == 2:
        return 3.0 * z**5 - 2.5 * z**3
    if which == 3:
        return max(v - 0.2, 0.0)
    if which == 4:
        return tanh(v / 0.1) * exp(-(((z - 0.3) / 0.3) ** 2))
    if which == 5:
        return v * z**2
    if which == 6:
        return sin(2.0 * pi * z / 0.8)
    if which == 7:
        return z * abs(v)
    if which == 8:
        return 2.0 * v / 0.3 / (1.0 + (v / 0.3) ** 2)
    if which == 9:
        return max(z - 0.4, 0.0)
    if which == 10:
        return v**3 + 0.5 * sin(2.0 * pi * z / 0.8)
    return v / 0.3 / (1.0 + (v / 0.3) ** 2) + v * z**2


_shape = inner(shape)


@inlined
def force_on_mass(z, velocity, y, p):
    """Force on the mass (N, up positive) at z (m) and z' (m/s)."""
    own = p.hidden_force
    return -own.force * _shape(int(own.shape), z / own.displacement, velocity / own.velocity)


def on_mass(numbers: dict[str, float], places: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """The force (N) (P, V) on the mass at ``places`` (P,) (m) and ``speeds`` (V,) (m/s)."""
    z, v = 1e3 * places / numbers["displacement_mm"], 1e3 * speeds / numbers["velocity_mm_per_s"]
    which = int(numbers["shape"])
    return -numbers["force_N"] * np.array([[shape(which, own, speed) for speed in v] for own in z])
