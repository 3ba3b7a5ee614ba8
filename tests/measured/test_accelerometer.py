"""An accelerometer alone, on a mass that is released: both kinds of file, and the unit of its noise."""

import re

import numpy as np

from tests.command import invoke

MODEL = """\
[oscillator]
mass_kg = 3.0
spring_N_per_mm = 1.2
normal_force_N = 2.5
[sweep]
friction_law = "coulomb"
beta = 1.0
amplitude_mm = 1.0
"""
MEASURED = """\
[measurement]
model = "model.toml"
[measurement.columns]
time = { column = "t", unit = "s" }
acceleration = { column = "a", unit = "m/s^2" }
[[measurement.test]]
file = "drop.csv"
kind = "transient"
"""
# Noise of the accelerometer, and what it shows of gravity (m/s^2).
NOISE, ZERO = 0.02, 0.3


def write(folder):
    time = np.arange(3000) / 500.0
    motion = (8e-3 - 1e-3 * time) * np.cos(20.0 * time)
    noise = NOISE * np.random.default_rng(1).standard_normal(time.size)
    table = np.column_stack([time, ZERO - 400.0 * motion + noise])
    np.savetxt(folder / "drop.csv", table, "%.6f", ",", header="t,a", comments="")
    (folder / "model.toml").write_text(MODEL)
    (folder / "measured.toml").write_text(MEASURED)
    return folder / "measured.toml"


def test_its_noise_is_told_in_its_unit(tmp_path):
    std, share = re.search(r"([\d.]+) m/s\^2 \(([\d.]+) %\)", invoke("check", write(tmp_path))).groups()
    assert 0.8 * NOISE < float(std) < 1.3 * NOISE
    assert 0.8 * NOISE / 3.2 < 0.01 * float(share) < 1.3 * NOISE / 3.2
