"""A spurious tone in the acceleration of the side frame (or of the table under it).

Its phase is another one in every measurement (``stray_vibration_phase`` of a case, 0 unless set), and
the response is not periodic in the forcing.
Neutral and default: acceleration = 0; frequency must be given.
"""

from math import cos, nan, pi, sin

import numpy as np

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = ("u'' -> u'' + acceleration sin(2 pi frequency t + phase)",)
SYMBOLS = {
    "phase": Meaning("phase of the tone, another one in every test", "rad"),
}

EFFECT = Effect(
    name="stray_vibration",
    family="excitation",
    branch=EXPERIMENTAL,
    meaning="a spurious tone in the acceleration of the {base}",
    quantities=(
        Quantity("acceleration_m_per_s2", 0.0, "amplitude of the tone", minimum=0.0, search=(0.0, 20.0)),
        Quantity(
            "frequency_hz",
            nan,
            "frequency of the tone",
            above=0.0,
            off=0.0,
            search=(1.0, 300.0),
            logarithmic=True,
        ),
    ),
    extends=("acceleration",),
)


# The tone is none of the input that was stated or recorded, so that a gain error of that leaves it as it is.
LAST = True
# ``phase`` (rad) is another one in every measurement.
DERIVED = ("phase",)


def sampled(t: np.ndarray, own: np.void) -> np.ndarray:
    """What is added to u'' (m/s^2) at some times (s); ``own``: the part of a record."""
    return own["acceleration"] * np.sin(2.0 * pi * own["frequency"] * t + own["phase"])


@term("stray_vibration", off="False")
def acts(p):
    """Whether there is a tone, so that the response does not repeat."""
    return p.stray_vibration.acceleration != 0.0


@inlined
def base_displacement(u, t, p):
    """U (m) with the tone, from that without."""
    if not acts(p):
        return u
    own = p.stray_vibration
    omega = 2.0 * pi * own.frequency
    return u - own.acceleration / omega**2 * sin(omega * t + own.phase)


@inlined
def base_velocity(u1, t, p):
    """U' (m/s) with the tone, from that without."""
    if not acts(p):
        return u1
    own = p.stray_vibration
    omega = 2.0 * pi * own.frequency
    return u1 - own.acceleration / omega * cos(omega * t + own.phase)


@inlined
def base_acceleration(u2, t, p):
    """U'' (m/s^2) with the tone, from that without."""
    if not acts(p):
        return u2
    own = p.stray_vibration
    return u2 + own.acceleration * sin(2.0 * pi * own.frequency * t + own.phase)


@inlined
def fastest(omega, p):
    """Highest angular frequency (rad/s) of the input."""
    return max(omega, 2.0 * pi * p.stray_vibration.frequency) if acts(p) else omega
