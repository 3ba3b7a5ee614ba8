"""Write examples/damper/rig.csv: a recording as people have them, of which the truth is known.

A crank moves a damper to and fro, twice in one file with a pause between. The file has no header; its columns
are ISO time, position (mm), force (N) and temperature (deg C). The logger's software reads its clock late by
chance, and the amplifier of the force delays it.
"""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np

FILE = Path(__file__).parents[1] / "examples" / "damper" / "rig.csv"
RATE, START = 200.0, datetime(2024, 10, 27, 1, 59, 56, tzinfo=UTC)
# Beginning (s), length (s), amplitude (mm) and frequency (Hz) of each run.
RUNS = ((0.0, 8.0, 20.0, 0.9), (14.0, 6.0, 12.0, 1.7))
# What moves (kg), the damper (N s/m) and the friction of its seal (N).
MASS, DAMPING, FRICTION = 1.5, 180.0, 14.0
DELAY, JITTER = 6e-3, 0.03  # s, and steps of the clock
NOISE_MM, NOISE_N = 2e-3, 0.3


def lines() -> list[str]:
    """Return the lines of the file."""
    random = np.random.default_rng(11)
    rows = []
    for start, length, amplitude, frequency in RUNS:
        t = start + np.arange(round(length * RATE)) / RATE
        omega = 2.0 * np.pi * frequency
        position = amplitude * np.sin(omega * t) + NOISE_MM * random.normal(size=t.size)
        late = t - DELAY
        velocity = 1e-3 * amplitude * omega * np.cos(omega * late)
        acceleration = -1e-3 * amplitude * omega**2 * np.sin(omega * late)
        force = MASS * acceleration + DAMPING * velocity + FRICTION * np.sign(velocity)
        force += 2.5 + NOISE_N * random.normal(size=t.size)
        temperature = 24.6 + 0.01 * t + 0.05 * random.normal(size=t.size)
        stamps = t + np.abs(JITTER * random.normal(size=t.size)) / RATE
        rows += zip(stamps, position, force, temperature, strict=True)
    return [
        f"{(START + timedelta(seconds=stamp)).strftime('%Y-%m-%d %H:%M:%S.%f')},{d:.3f},{f:.2f},{c:.1f}"
        for stamp, d, f, c in rows
    ]


if __name__ == "__main__":
    FILE.write_text("\n".join(lines()) + "\n")
