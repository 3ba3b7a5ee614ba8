"""A recorded force on the mass beside the one that is measured, or that drives it."""

from pathlib import Path

import numpy as np
import pytest

from wedgesweep.measured import MeasuredError, read

MODEL = """
[oscillator]
mass_kg = 1.0
spring_N_per_mm = 1.0
contact = "ground"
[sweep]
friction_law = "coulomb"
excitation = "{excitation}"
frequency_hz = 1.0
{amplitude} = 1.0
"""
MEASURED = """
[measurement]
model = "model.toml"
[measurement.columns]
time = {{ column = "t", unit = "s" }}
displacement = {{ column = "x", unit = "mm", of = "absolute" }}
{other}
known_force = {{ column = "p", unit = "N", scale = 50.0, sign = -1 }}
[[measurement.test]]
file = "test.csv"
kind = "{kind}"
"""
FORCED, MOVED = ("force", "amplitude_N"), ("base", "amplitude_mm")
LOOP = 'force = { column = "F", unit = "N" }'
INPUT = 'input = { column = "F", unit = "N", quantity = "force" }'
BASE = 'input = { column = "F", unit = "mm", quantity = "displacement" }'


def write(folder: Path, excitation: tuple[str, str], kind: str, other: str) -> Path:
    time = np.arange(2000) / 200.0
    x, force = 5.0 * np.sin(2.0 * np.pi * time), 3.0 + 2.0 * np.cos(2.0 * np.pi * time)
    pressure = 1.0 + 0.01 * np.sin(7.0 * time)
    table = np.column_stack([time, x, force, pressure])
    np.savetxt(folder / "test.csv", table, "%.9g", ",", header="t,x,F,p", comments="")
    (folder / "model.toml").write_text(MODEL.format(excitation=excitation[0], amplitude=excitation[1]))
    (folder / "measured.toml").write_text(MEASURED.format(kind=kind, other=other))
    return folder / "measured.toml"


@pytest.mark.parametrize(
    ("excitation", "kind", "other", "channel"),
    [(MOVED, "loop", LOOP, "force"), (FORCED, "transient", INPUT, "input")],
)
def test_a_known_force_is_added_to_the_other_one(
    tmp_path: Path, excitation: tuple[str, str], kind: str, other: str, channel: str
) -> None:
    (test,) = read(write(tmp_path, excitation, kind, other)).tests
    time = np.arange(2000) / 200.0
    known = -50.0 * (1.0 + 0.01 * np.sin(7.0 * time))
    expected = 3.0 + 2.0 * np.cos(2.0 * np.pi * time) + known
    assert getattr(test, channel) == pytest.approx(expected, abs=1e-5)


def test_a_known_force_beside_a_moving_base_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MeasuredError, match="known_force: it is not simulated beside a base that moves"):
        read(write(tmp_path, MOVED, "transient", BASE))
