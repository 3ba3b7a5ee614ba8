"""The motion of the base, or the force on the mass, as a sensor records it, without noise."""

from math import pi

import numpy as np

from wedgesweep.synthesize.names import FORCE, QUANTITIES


def recorded(record: np.ndarray, time: np.ndarray, quantity: str) -> np.ndarray:
    """Base motion of a parameter record, shape (1,), at some times (n,) from phase 0, in SI units.

    A force has the shape of the displacement.
    """
    given, distortion, stray = (record[each][0] for each in ("input", "input_distortion", "stray_vibration"))
    a, omega = given["amplitude"], given["omega"]
    waves = [
        (a, omega, 0.0),
        (a * distortion["second"], 2.0 * omega, distortion["second_phase"]),
        (a * distortion["third"], 3.0 * omega, distortion["third_phase"]),
    ]
    if stray["acceleration"] != 0.0:
        tone = 2.0 * pi * stray["frequency"]
        waves.append((-stray["acceleration"] / tone**2, tone, stray["phase"]))
    order = 0 if quantity == FORCE else QUANTITIES.index(quantity)
    # Each derivative multiplies by the frequency and advances the phase by a quarter of a turn.
    parts = [
        size * rate**order * np.sin(rate * time + phase + 0.5 * pi * order) for size, rate, phase in waves
    ]
    return np.sum(parts, axis=0)
