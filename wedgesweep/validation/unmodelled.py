"""Data of the independent simulator, with effects that no candidate stands for."""

from collections.abc import Mapping, Sequence
from math import ceil, pi
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wedgesweep.config import from_document
from wedgesweep.synthesize import files
from wedgesweep.synthesize.noise import NOISES
from wedgesweep.validation import response, simulator
from wedgesweep.validation.response import HARMONICS, SAMPLES, Test
from wedgesweep.validation.strength import LEVEL, PERIODS, SAMPLING_HZ

if TYPE_CHECKING:
    from wedgesweep.validation.draft import Draft

# The parameter of each effect (SI units), from hardly noticeable to very strong.
RANGES = {
    "backlash": ("width", 5e-7, 4e-4),
    "drag": ("coefficient", 0.1, 5000.0),
    "drift": ("rise", 1e-3, 0.6),
}
# Candidates that stand for them, and are left out.
CANDIDATES = {"backlash": "backlash", "drag": "quadratic_drag"}
# Steps (s) of data and of estimates, and the periods before they start.
STEP, COARSE_STEP, SETTLE, COARSE_SETTLE = 5e-6, 2e-5, 60, 30
# Normal force (N) that the wedges must keep.
LEAST_FORCE = 0.05
SAMPLING_SPREAD = 0.03


def numbers(name: str, strength: float) -> dict[str, float]:
    """Parameter of an effect at a strength from 0 to 1."""
    key, weak, strong = RANGES[name]
    return {key: float(f"{weak * (strong / weak) ** strength:.6g}")}


def name_of(effect: Mapping[str, float]) -> str:
    """Name of the effect that has these parameters."""
    return next(name for name, (key, *_) in RANGES.items() if key in effect)


def spectra(
    law: str, lean_deg: float, tests: Sequence[Test], effect: Mapping[str, float]
) -> tuple[np.ndarray, float]:
    """Roughly the spectra of the tests, as ``response.spectra`` has them, and the smallest normal force."""
    found, least = np.zeros((len(tests), 2, HARMONICS + 1), complex), np.inf
    amplitudes = 1e-3 * np.array([test.amplitude for test in tests])
    for row, system in zip(found, _systems((law, lean_deg), tests, amplitudes, effect), strict=True):
        period = 2.0 * pi / system.omega
        stride = ceil(period / COARSE_STEP / SAMPLES)
        step = period / SAMPLES / stride
        signal, force = simulator.simulate(system, step, COARSE_SETTLE * SAMPLES * stride, stride, SAMPLES)
        row[:, :HARMONICS] = response.harmonics(-signal)
        least = min(least, force)
    return found, least


def make(draft: "Draft", seed: int, directory: Path) -> None:
    """Write the same files as ``wedgesweep synthesize``."""
    assert draft.lean is not None
    random = np.random.default_rng(seed)
    factors = {name: 1.0 + std * float(random.normal()) for name, std in draft.uncertain.items()}
    errors = (draft.spread or 0.0) * random.normal(size=len(draft.tests))
    amplitudes = 1e-3 * np.array([test.amplitude for test in draft.tests]) * (1.0 + errors)
    tables, stated = [], []
    systems = _systems((draft.law, draft.lean), draft.tests, amplitudes, draft.unmodelled)
    for i, (test, system) in enumerate(zip(draft.tests, systems, strict=True)):
        true = system._replace(friction=system.friction * factors.get("friction_level", 1.0))
        tables.append(_table(true, draft.noise, random))
        stated.append(
            {"file": f"test-{i:02d}.csv", **draft.system({}).test_keys(test), "amplitude_std": draft.spread}
        )
    columns = {
        "time": {"column": "t", "unit": "s"},
        "displacement": {"column": "d", "unit": "mm"},
        "velocity": {"column": "v", "unit": "mm/s", "derived": draft.noise == "differentiated"},
    }
    head = {"title": directory.name, "model": "model.toml", "columns": columns, "uncertain": draft.uncertain}
    truth = {"effects": {name_of(draft.unmodelled): draft.unmodelled}, "uncertain": factors}
    model = from_document(draft.system({}).document())
    files.write(directory, {"measurement": {**head, "test": stated}}, model, tables, truth)


def _systems(
    model: tuple[str, float], tests: Sequence[Test], amplitudes: np.ndarray, effect: Mapping[str, float]
) -> list[simulator.System]:
    """The system of each test; ``model`` is law and lean (deg), ``amplitudes`` (m) has shape (tests,)."""
    friction = simulator.drifting_friction(effect.get("rise", 0.0), len(tests)).tolist()
    return [
        simulator.system(*model, test.frequency_hz, amplitude, {**effect, "friction": factor})
        for test, amplitude, factor in zip(tests, amplitudes.tolist(), friction, strict=True)
    ]


def _table(system: simulator.System, noise: str, random: np.random.Generator) -> files.Table:
    """One test as its file shows it, with a random start phase and a sampling rate near 2 kHz."""
    rate = SAMPLING_HZ * (1.0 + SAMPLING_SPREAD * random.uniform(-1.0, 1.0))
    stride = ceil(1.0 / rate / STEP)
    step = 1.0 / rate / stride
    period = 2.0 * pi / system.omega
    samples = ceil(PERIODS * period * rate) + 2
    skipped = int((SETTLE + random.random()) * period / step)
    signal, _ = simulator.simulate(system, step, skipped, stride, samples)
    offset = random.normal() * signal[0].std()
    displacement, velocity = NOISES[noise]((offset - signal[0], -signal[1]), LEVEL, 1.0 / rate, random)
    return files.Table(np.arange(displacement.size) / rate, 1e3 * displacement, 1e3 * velocity)
