"""Data of the independent simulator, in the same files as ``wedgesweep synthesize`` writes."""

from math import ceil, pi
from pathlib import Path

import numpy as np

from validation import simulator, unmodelled
from validation.draft import Draft
from validation.strength import LEVEL, PERIODS, SAMPLING_HZ
from wedgesweep.config import from_document
from wedgesweep.synthesize import files
from wedgesweep.synthesize.noise import NOISES

# Step (s) of the simulation, and the periods before its response is taken.
STEP, SETTLE = 5e-6, 60
SAMPLING_SPREAD = 0.03


def make(draft: Draft, seed: int, directory: Path) -> None:
    """Write the same files as ``wedgesweep synthesize``."""
    assert draft.column_angle_deg is not None
    random = np.random.default_rng(seed)
    factors = {name: 1.0 + std * float(random.normal()) for name, std in draft.uncertain.items()}
    errors = (draft.spread or 0.0) * random.normal(size=len(draft.tests))
    amplitudes = 1e-3 * np.array([test.amplitude for test in draft.tests]) * (1.0 + errors)
    tables, stated = [], []
    systems = unmodelled.systems(
        (draft.law, draft.column_angle_deg), draft.tests, amplitudes, draft.unmodelled
    )
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
    truth = {"effects": {unmodelled.name_of(draft.unmodelled): draft.unmodelled}, "uncertain": factors}
    model = from_document(draft.system({}).document())
    files.write(directory, {"measurement": {**head, "test": stated}}, model, tables, truth)


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
