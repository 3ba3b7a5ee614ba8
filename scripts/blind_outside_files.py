"""Data sets of the independent simulator: effects that no candidate of wedgesweep stands for."""

from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import blind_outside as outside
import blind_strength as strength
import numpy as np

from wedgesweep.config import parse
from wedgesweep.synthesize import files
from wedgesweep.synthesize.noise import NOISES

if TYPE_CHECKING:
    from blind_draft import Draft

# Number of each effect from hardly there to very strong (SI units).
RANGES = {
    "backlash": ("width", 5e-7, 4e-4),
    "drag": ("coefficient", 0.1, 5000.0),
    "drift": ("rise", 1e-3, 0.6),
}
# Steps (s) of data and of estimates, and periods before them.
STEP, ROUGH_STEP, SETTLE, ROUGH_SETTLE = 5e-6, 2e-5, 60, 30
PHASES = 128
LEAST_FORCE = 0.05


def systems(draft: "Draft", foreign: dict[str, Any], amplitudes: np.ndarray) -> list[outside.System]:
    """The system of each test; ``amplitudes`` (T,) in m."""
    friction = outside.session(foreign.get("rise", 0.0), len(draft.tests))
    return [
        outside.system(draft.law, draft.lean, test.frequency_hz, float(a), {**foreign, "friction": float(f)})
        for test, a, f in zip(draft.tests, amplitudes, friction, strict=True)
    ]


def _nominal(draft: "Draft") -> np.ndarray:
    return 1e-3 * np.array([test.amplitude_mm for test in draft.tests])


def harmonics(draft: "Draft", foreign: dict[str, Any]) -> tuple[np.ndarray, float]:
    """Responses (T, 2, H) as ``blind_strength`` has them, roughly, and the smallest normal force."""
    turn = np.exp(-2j * pi * np.outer(np.arange(PHASES) / PHASES, np.arange(1, strength.COMPARED + 1)))
    found, least = [], np.inf
    for system in systems(draft, foreign, _nominal(draft)):
        period = 2.0 * pi / system.omega
        stride = int(np.ceil(period / ROUGH_STEP / PHASES))
        step = period / PHASES / stride
        signal, force = outside.follow(system, step, ROUGH_SETTLE * PHASES * stride, stride, PHASES)
        found.append(-2.0 / PHASES * signal @ turn)
        least = min(least, force)
    return np.array(found), least


def hide(turn: int, draft: "Draft", target: float, random: np.random.Generator) -> bool:
    """Give a draft one of the effects, as strong as wanted; False if that cannot be."""
    name = tuple(RANGES)[turn % len(RANGES)]
    key, weak, strong = RANGES[name]
    if name == "drift":  # the order of the tests is no order of frequencies
        draft.tests = [draft.tests[i] for i in random.permutation(len(draft.tests))]

    def numbers(s: float) -> dict[str, Any]:
        return {"name": name, key: float(f"{weak * (strong / weak) ** s:.6g}")}

    s = strength.reach(target, lambda s: draft.excess(harmonics(draft, numbers(s))[0], None, {}))
    if s is None:
        return False
    draft.foreign = numbers(s)
    mean, least = harmonics(draft, draft.foreign)
    draft.expected = draft.excess(mean, None, {})
    return least > LEAST_FORCE


def make(draft: "Draft", level: float, seed: int, directory: Path) -> None:
    """Write the same files as ``wedgesweep synthesize``."""
    random = np.random.default_rng(seed)
    factors = {name: 1.0 + std * float(random.normal()) for name, std in draft.uncertain.items()}
    amplitudes = _nominal(draft) * (1.0 + (draft.spread or 0.0) * random.normal(size=len(draft.tests)))
    tables, told = [], []
    scale = factors.get("friction_level", 1.0)
    for i, system in enumerate(systems(draft, draft.foreign or {}, amplitudes)):
        true = system._replace(friction=system.friction * scale)
        tables.append(_record(true, draft.noise, level, random))
        test = draft.tests[i]
        stated = {"amplitude_mm": test.amplitude_mm, "amplitude_std": draft.spread}
        told.append({"file": f"test-{i:02d}.csv", "frequency_hz": test.frequency_hz, **stated})
    columns = {
        "time": {"column": "t", "unit": "s"},
        "displacement": {"column": "d", "unit": "mm"},
        "velocity": {"column": "v", "unit": "mm/s", "derived": draft.noise == "differentiated"},
    }
    head = {"title": directory.name, "model": "model.toml", "columns": columns, "uncertain": draft.uncertain}
    truth = {"effects": {draft.foreign["name"]: draft.foreign}, "uncertain": factors} if draft.foreign else {}
    model = parse(draft.model().to_toml())
    files.write(directory, {"measurement": {**head, "test": told}}, model, tables, truth)


def _record(system: outside.System, noise: str, level: float, random: np.random.Generator) -> files.Table:
    """One test as its file shows it: any start phase, near 2 kHz."""
    rate = strength.SAMPLING_HZ * (1.0 + 0.03 * random.uniform(-1.0, 1.0))
    stride = int(np.ceil(1.0 / rate / STEP))
    step = 1.0 / rate / stride
    period = 2.0 * pi / system.omega
    samples = int(np.ceil(strength.PERIODS * period * rate)) + 2
    before = int((SETTLE + random.random()) * period / step)
    signal, _ = outside.follow(system, step, before, stride, samples)
    channels = (-signal[0] + random.normal() * signal[0].std(), -signal[1])
    displacement, velocity = NOISES[noise](channels, level, 1.0 / rate, random)
    return files.Table(np.arange(displacement.size) / rate, 1e3 * displacement, 1e3 * velocity)
