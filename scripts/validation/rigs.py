"""The mechanical systems of a campaign: the paper's bench, rigs of any size, and a mass on a spring."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import pi
from typing import Any

import numpy as np

from wedgesweep.config import Config, from_document
from wedgesweep.natural_units import FREQUENCY, VELOCITY, NaturalUnits, natural_units

Sections = Mapping[str, Mapping[str, Any]]

# Accelerations (m/s^2) of the side frame that are tried, and forces on an oscillator over that of friction.
ACCELERATIONS = np.geomspace(0.35, 4.0, 40)
FORCES = np.geomspace(0.8, 8.0, 40)
# Ranges of the rigs of any size.
MASS_KG, FREQUENCY_HZ = (0.1, 1e4), (0.5, 50.0)
WEDGE_ANGLE_DEG, COLUMN_ANGLE_DEG = (30.0, 45.0), (-6.0, 6.0)
# Proportions of the bench, about which others are drawn, and how far their logarithm may be off.
WEDGE_MASS, SIDE_FRAME_MASS, WEDGE_SPRING, SPREAD = 0.17 / 0.70, 0.46 / 0.70, 2.55 / 5.10, 0.3
# Force of each wedge's spring that stands on the bolster: about 1.5 to 3 times the weight of a wedge.
PRELOAD_N = (2.8, 4.5)
# Damping ratio of an oscillator, friction over its weight, and its travel over the static deflection by the
# force of friction.
DAMPING, FRICTION, TRAVEL = (0.005, 0.05), (0.02, 0.3), 3.0
# Threshold velocity in natural units, about that of the bench.
THRESHOLD, GRAVITY = 0.01, 9.80665
# What an oscillator rubs on and what moves it, in turn.
KINDS = (("base", "base"), ("ground", "base"), ("base", "force"), ("ground", "force"))


@dataclass(frozen=True)
class Rig:
    """A mechanical system without its law of friction and its effects, as sections of a config."""

    sections: Sections = field(default_factory=dict)
    excitation: str = "base"

    def document(self, law: str, effects: Mapping[str, Mapping[str, float]]) -> dict[str, Any]:
        """Its config, but for the tests."""
        driven = {"excitation": self.excitation} if self.forced else {}
        sweep = {"friction_law": law, "beta": 1.0, self.amplitude_key: 0.1, **driven}
        return {"title": "system under test", **self.sections, "effects": effects, "sweep": sweep}

    @property
    def forced(self) -> bool:
        return self.excitation == "force"

    @property
    def amplitude_key(self) -> str:
        """Key of the amplitude of its input, in whose unit amplitudes are."""
        return "amplitude_N" if self.forced else "amplitude_mm"

    @cached_property
    def _model(self) -> Config:
        return from_document(self.document("coulomb", {}))

    @property
    def is_oscillator(self) -> bool:
        return self._model.system == "oscillator"

    @cached_property
    def units(self) -> NaturalUnits:
        if not self.is_oscillator:
            return self._model.natural_units()
        own = self._model.oscillator
        return natural_units(own["mass"], own["spring"], travel=TRAVEL * self._friction / own["spring"])

    @property
    def _friction(self) -> float:
        """Force of dynamic friction (N) of an oscillator."""
        return self._model.friction["dynamic"] * self._model.oscillator["normal_force"]

    @property
    def deflection(self) -> float:
        """Static displacement (m) by an input of amplitude 1."""
        return 1.0 / self._model.oscillator["spring"] if self.forced else 1e-3

    @property
    def recorded_quantities(self) -> tuple[str, ...]:
        """What may be recorded of its input."""
        return ("force",) if self.forced else ("displacement", "velocity", "acceleration")

    @property
    def possible_effects(self) -> tuple[str, ...]:
        return self._model.possible_effects

    @property
    def relative(self) -> bool:
        """Whether its sensors measure the motion relative to the base."""
        return not self.is_oscillator or (not self.forced and self._model.oscillator["contact"] == "base")

    def amplitudes(self, frequency: float) -> np.ndarray:
        """Amplitudes to try at a frequency (Hz), from what friction holds to what hardly feels it."""
        omega = 2.0 * pi * frequency
        if not self.is_oscillator:
            return 1e3 * ACCELERATIONS / omega**2
        force, own = FORCES * self._friction, self._model.oscillator
        if self.forced:
            return force
        return 1e3 * force / (own["mass"] * omega**2 if self.relative else own["spring"])


def bench(column_angle_deg: float) -> Rig:
    """The paper's bench with its column at some angle."""
    return Rig({"suspension": {"column_angle_deg": column_angle_deg}})


def constant_damping(random: np.random.Generator) -> Rig:
    """The paper's bench with the springs of its wedges on the bolster."""
    preload = float(f"{random.uniform(*PRELOAD_N):.3g}")
    return Rig({"suspension": {"damping": "constant", "wedge_preload_N": preload}})


def any_size(random: np.random.Generator) -> Rig:
    """A suspension of any size, in proportions about those of the bench."""
    mass, frequency = logarithmic(MASS_KG, random), logarithmic(FREQUENCY_HZ, random)
    stiffness = mass * (2.0 * pi * frequency) ** 2
    units = natural_units(mass, stiffness, GRAVITY)
    suspension = {
        "bolster_mass_kg": mass,
        "wedge_mass_kg": mass * WEDGE_MASS * _about_one(random),
        "side_frame_mass_kg": mass * SIDE_FRAME_MASS * _about_one(random),
        "bolster_spring_N_per_mm": 1e-3 * stiffness,
        "wedge_spring_N_per_mm": 1e-3 * stiffness * WEDGE_SPRING * _about_one(random),
        "wedge_angle_deg": random.uniform(*WEDGE_ANGLE_DEG),
        "column_angle_deg": random.uniform(*COLUMN_ANGLE_DEG),
    }
    friction = {"threshold_velocity_mm_per_s": units.ratio(VELOCITY)}
    return Rig({"suspension": rounded(suspension), "friction": rounded(friction)})


def oscillator(index: int, random: np.random.Generator) -> Rig:
    """A mass on a spring, of any size; contacts and excitations take turns."""
    # Every kind comes with every kind of noise, which takes turns of four as well.
    contact, excitation = KINDS[(index + index // len(KINDS)) % len(KINDS)]
    mass, omega = logarithmic(MASS_KG, random), 2.0 * pi * logarithmic(FREQUENCY_HZ, random)
    normal_force = mass * GRAVITY * logarithmic(FRICTION, random)
    numbers = on_spring(mass, omega, random.uniform(*DAMPING), normal_force)
    rig = Rig({"oscillator": {**numbers, "contact": contact}}, excitation)
    threshold = {"threshold_velocity_mm_per_s": 1e3 * THRESHOLD * rig.units.length / rig.units.time}
    return Rig({**rig.sections, "friction": rounded(threshold)}, excitation)


def on_spring(mass: float, omega: float, damping_ratio: float, normal_force: float) -> dict[str, float]:
    """Keys of a mass (kg) on a spring, by its natural frequency (rad/s) and normal force (N)."""
    numbers = {
        "mass_kg": mass,
        "spring_N_per_mm": 1e-3 * mass * omega**2,
        "damping_N_s_per_m": 2.0 * damping_ratio * mass * omega,
        "normal_force_N": normal_force,
    }
    return rounded(numbers)


def frequency_ratio(rig: Rig) -> float:
    """Its natural frequency over that of the bench."""
    return rig.units.ratio(FREQUENCY)


def logarithmic(limits: tuple[float, float], random: np.random.Generator) -> float:
    """Draw a number whose logarithm is uniform between limits."""
    return float(np.exp(random.uniform(*np.log(limits))))


def _about_one(random: np.random.Generator) -> float:
    return float(np.exp(random.uniform(-SPREAD, SPREAD)))


def rounded(numbers: Mapping[str, float]) -> dict[str, float]:
    """The numbers with six digits, as a config states them."""
    return {key: float(f"{value:.6g}") for key, value in numbers.items()}
