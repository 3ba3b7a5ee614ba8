"""Harmonics in the motion of the side frame (or of the table under it); a force has them in the same way.

Neutral and default: second = third = 0; both phases 0.
"""

from math import cos, sin

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = (
    "u = a (sin(omega t) + second sin(2 omega t + second_phase) + third sin(3 omega t + third_phase))",
)

EFFECT = Effect(
    name="input_distortion",
    family="excitation",
    branch=EXPERIMENTAL,
    meaning="harmonics in the input",
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


@term("input_distortion", off="False")
def acts(p):
    """Whether the input has further harmonics."""
    return p.input_distortion.second != 0.0 or p.input_distortion.third != 0.0


@inlined
def base_displacement(u, t, p):
    """U (m) with the harmonics, from that without."""
    own, phase = p.input_distortion, p.input.omega * t
    wave = own.second * sin(2.0 * phase + own.second_phase) + own.third * sin(3.0 * phase + own.third_phase)
    return u + p.input.amplitude * wave


# A force has its harmonics in the same way.
input_force = base_displacement


@inlined
def base_velocity(u1, t, p):
    """U' (m/s) with the harmonics, from that without."""
    own, phase = p.input_distortion, p.input.omega * t
    wave = 2.0 * own.second * cos(2.0 * phase + own.second_phase)
    wave += 3.0 * own.third * cos(3.0 * phase + own.third_phase)
    return u1 + p.input.amplitude * p.input.omega * wave


@inlined
def base_acceleration(u2, t, p):
    """U'' (m/s^2) with the harmonics, from that without."""
    own, phase = p.input_distortion, p.input.omega * t
    wave = 0.0
    if own.second != 0.0:
        wave += 4.0 * own.second * sin(2.0 * phase + own.second_phase)
    if own.third != 0.0:
        wave += 9.0 * own.third * sin(3.0 * phase + own.third_phase)
    return u2 - p.input.amplitude * p.input.omega**2 * wave


@inlined
def fastest(omega, p):
    """Highest angular frequency (rad/s) of the input."""
    if p.input_distortion.third != 0.0:
        return max(omega, 3.0 * p.input.omega)
    return max(omega, 2.0 * p.input.omega) if p.input_distortion.second != 0.0 else omega
