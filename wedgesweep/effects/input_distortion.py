"""Harmonics in the motion of the side frame (or of the table under it).

    u = a (sin wt + second sin(2wt + second_phase) + third sin(3wt + third_phase))

Neutral and default: second = third = 0; both phases 0.
"""

from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="input_distortion",
    family="excitation",
    branch=EXPERIMENTAL,
    meaning="harmonics in the motion of the side frame",
    quantities=(
        Quantity("second", 0.0, "second harmonic over the first", minimum=0.0, search=(0.0, 0.5)),
        Quantity("second_phase_deg", 0.0, "phase of the second harmonic", search=(-180.0, 180.0)),
        Quantity("third", 0.0, "third harmonic over the first", minimum=0.0, search=(0.0, 0.5)),
        Quantity("third_phase_deg", 0.0, "phase of the third harmonic", search=(-180.0, 180.0)),
    ),
    extends=(
        "second",
        "third",
    ),
)
