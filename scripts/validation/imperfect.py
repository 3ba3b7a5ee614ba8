"""A bench that is not quite what its model says: small errors of everything that one measures or buys."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from validation.response import Effects
from validation.rigs import Rig
from wedgesweep.uncertain import DISTORTION

# Standard deviations of the errors: relative ones, and those of angles in degrees.
RELATIVE = {
    "suspension": {
        "bolster_mass_kg": (0.70, 0.005),
        "wedge_mass_kg": (0.17, 0.005),
        "bolster_spring_N_per_mm": (5.10, 0.01),
        "wedge_spring_N_per_mm": (2.55, 0.01),
    },
    "friction": {"dynamic": (0.29, 0.03), "static": (0.32, 0.03)},
}
WEDGE_ANGLE_DEG, WEDGE_ANGLE_STD, COLUMN_ANGLE_STD = 37.5, 0.2, 0.1
# Of the second and third harmonic of an input whose amplitude is stated, and of one that is recorded.
HARMONICS, RECORDED_HARMONICS = 0.002, 0.01
GAIN = 0.005
# Relative std of stated amplitudes.
AMPLITUDE = 0.005
# Model error that is allowed for.
MODEL_ERROR = 0.02
# What a user declares of this; harmonics of an input that is stated.
DECLARED = {"bolster_mass": 0.005, "bolster_stiffness": 0.01, "wedge_stiffness": 0.01, "friction_level": 0.03}
DECLARED_INPUT = {DISTORTION: HARMONICS}
# Effects that stand for errors which are there in truth.
EFFECTS = (*DECLARED, DISTORTION, "displacement_gain")
# The errors of consecutive sets are these multiples.
SIZES = (0.5, 1.0, 2.0)


@dataclass(frozen=True)
class Errors:
    """The true rig beside that of the model, effects of the errors, and what a user declares of them."""

    rig: Rig
    effects: Effects
    spread: float
    uncertain: Mapping[str, float]


def draw(size: float, recorded: bool, column_angle_deg: float, random: np.random.Generator) -> Errors:
    """Draw twelve errors of a relative ``size``: eleven here, that of the amplitudes with the data."""

    def near(value: float, std: float) -> float:
        return float(f"{value + size * std * random.normal():.6g}")

    sections = {
        section: {key: near(value, std * value) for key, (value, std) in numbers.items()}
        for section, numbers in RELATIVE.items()
    }
    angles = {
        "wedge_angle_deg": near(WEDGE_ANGLE_DEG, WEDGE_ANGLE_STD),
        "column_angle_deg": near(column_angle_deg, COLUMN_ANGLE_STD),
    }
    sections["suspension"] |= angles
    harmonics = RECORDED_HARMONICS if recorded else size * HARMONICS
    second, third = np.abs(harmonics * random.normal(size=2)).tolist()
    phases = random.uniform(-180.0, 180.0, 2).tolist()
    distortion = {
        "second": second,
        "second_phase_deg": phases[0],
        "third": third,
        "third_phase_deg": phases[1],
    }
    effects = {DISTORTION: distortion, "displacement_gain": {"scale": near(1.0, GAIN)}}
    declared = DECLARED if recorded else DECLARED | DECLARED_INPUT
    uncertain = {name: size * std for name, std in declared.items()}
    return Errors(Rig(sections), effects, size * AMPLITUDE, uncertain)
