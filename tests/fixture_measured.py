"""A small measurement of one made-up vibration, for tests of its reader."""

from pathlib import Path

import numpy as np

FREQUENCY, PERIODS, SAMPLING = 20.0, 10.3, 1000.0
NOISE = 0.02

MEASURED = """\
[measurement]
title = "bench"
model = "model.toml"
[measurement.columns]
time = { column = "t", unit = "s" }
displacement = { column = "d", unit = "mm" }
velocity = { column = "v", unit = "mm/s" }
[[measurement.test]]
file = "one.csv"
frequency_hz = 20.0
amplitude_mm = 0.3
amplitude_std = 0.01
"""
MODEL = """\
title = "on trial"
[sweep]
friction_law = "static-dynamic"
beta = 1.0
amplitude_mm = 0.1
"""


def vibration(
    frequency: float = FREQUENCY, periods: float = PERIODS, drift: float = 0.0, seed: int = 0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time (s), displacement (mm) and velocity (mm/s) with noise; ``drift`` is relative over the record."""
    random = np.random.default_rng(seed)
    t = np.arange(round(periods / frequency * SAMPLING)) / SAMPLING
    omega = 2.0 * np.pi * frequency
    phase = omega * (t + 0.5 * drift * t * (t - t[-1]) / t[-1]) + 0.7
    d = 5.0 + np.cos(phase) + 0.3 * np.sin(3.0 * phase)
    v = omega * (-np.sin(phase) + 0.9 * np.cos(3.0 * phase))
    return t, d + NOISE * random.normal(size=t.size), v + NOISE * omega * random.normal(size=t.size)


def csv_lines(*columns: np.ndarray) -> list[str]:
    """Time, displacement and velocity as the lines of a CSV file."""
    return ["t,d,v", *(f"{t:.4f},{d:.6g},{v:.6g}" for t, d, v in zip(*columns, strict=True))]


def lines(*arguments: float, **more: float) -> list[str]:
    """``vibration`` as the lines of a CSV file."""
    return csv_lines(*vibration(*arguments, **more))


def write(
    directory: Path, measured: str = MEASURED, model: str = MODEL, csv: list[str] | None = None
) -> Path:
    """Write the files; the path of measured.toml."""
    (directory / "model.toml").write_text(model)
    (directory / "one.csv").write_text("\n".join(lines() if csv is None else csv) + "\n")
    (directory / "measured.toml").write_text(measured)
    return directory / "measured.toml"
