"""Effects of the independent simulator, which no candidate stands for, and what they cause."""

from collections.abc import Mapping, Sequence
from math import ceil, pi

import numpy as np

from validation import response, simulator
from validation.response import HARMONICS, SAMPLES, Test

# The parameter of each effect (SI units), from hardly noticeable to very strong.
RANGES = {
    "backlash": ("width", 5e-7, 4e-4),
    "drag": ("coefficient", 0.1, 5000.0),
    "drift": ("rise", 1e-3, 0.6),
}
# Candidates that stand for them, and are left out.
CANDIDATES = {"backlash": "backlash", "drag": "quadratic_drag"}
# Step (s) of the simulation, and the periods before its response is taken.
STEP, SETTLE = 2e-5, 30
# Normal force (N) that the wedges must keep.
LEAST_FORCE = 0.05


def numbers(name: str, strength: float) -> dict[str, float]:
    """Parameter of an effect at a strength from 0 to 1."""
    key, weak, strong = RANGES[name]
    return {key: float(f"{weak * (strong / weak) ** strength:.6g}")}


def name_of(effect: Mapping[str, float]) -> str:
    """Name of the effect that has these parameters."""
    return next(name for name, (key, *_) in RANGES.items() if key in effect)


def spectra(
    law: str, column_angle_deg: float, tests: Sequence[Test], effect: Mapping[str, float]
) -> tuple[np.ndarray, float]:
    """Roughly the spectra of the tests, as ``response.spectra`` has them, and the smallest normal force."""
    found, least = np.zeros((len(tests), 2, HARMONICS + 1), complex), np.inf
    amplitudes = 1e-3 * np.array([test.amplitude for test in tests])
    for row, system in zip(found, systems((law, column_angle_deg), tests, amplitudes, effect), strict=True):
        period = 2.0 * pi / system.omega
        stride = ceil(period / STEP / SAMPLES)
        step = period / SAMPLES / stride
        signal, force = simulator.simulate(system, step, SETTLE * SAMPLES * stride, stride, SAMPLES)
        row[:, :HARMONICS] = response.harmonics(-signal)
        least = min(least, force)
    return found, least


def systems(
    model: tuple[str, float], tests: Sequence[Test], amplitudes: np.ndarray, effect: Mapping[str, float]
) -> list[simulator.System]:
    """System of each test; ``model``: law and column angle (deg); ``amplitudes`` (m) has shape (tests,)."""
    friction = simulator.drifting_friction(effect.get("rise", 0.0), len(tests)).tolist()
    return [
        simulator.system(*model, test.frequency_hz, amplitude, {**effect, "friction": factor})
        for test, amplitude, factor in zip(tests, amplitudes.tolist(), friction, strict=True)
    ]
