"""Recordings as other people have them are read as they are; they are no part of the project."""

from pathlib import Path

import numpy as np
import pytest

from tests.command import invoke
from wedgesweep import measured

REAL = Path(__file__).parents[3] / "shared" / "real"
pytestmark = pytest.mark.skipif(not REAL.is_dir(), reason="the recordings are not here")
MODEL = """
[oscillator]
mass_kg = 1.0
spring_N_per_mm = 0.02
damping_N_s_per_m = 1.0
normal_force_N = 10.0
[sweep]
friction_law = "coulomb"
beta = 1.0
amplitude_mm = 1.0
"""
ROTOR = """
[oscillator]
motion = "rotation"
inertia_kg_m2 = 1.0
spring_N_m_per_rad = 20.0
contact = "ground"
[sweep]
friction_law = "coulomb"
beta = 1.0
amplitude_rad = 1.0
"""
SEAL = """
time = { column = 1, unit = "ms" }
displacement = { column = 5, unit = "mm" }
force = { column = 7, unit = "N" }
"""
DYNO = """
time = { column = "Timestamp", unit = "datetime" }
displacement = { column = "Displacement (mm)", unit = "mm" }
force = { column = "Force (N)", unit = "N" }
"""
RACK = """
time = { column = 1, unit = "s" }
velocity = { column = 2, unit = "m/s", scale = 3.333e-4, file = "a3MR.csv", delay_ms = 4.0 }
input = { column = "Force", unit = "N", scale = 200.0, quantity = "force" }
"""
TORSION = """
time = { column = "Time (s) Run #1", unit = "s" }
displacement = { column = "Angle, Ch 1+2 (rad) Run #1", unit = "rad" }
"""
SPRING = """
time = { column = 1, unit = "s" }
displacement = { column = 2, unit = "mm" }
"""
FRAME = """
time = { column = "time_s", unit = "s" }
displacement = { column = "plate_mm", unit = "mm", of = "absolute" }
input = { column = "base_mm", unit = "mm", quantity = "displacement" }
"""
EMPS = """
time = { column = "time_s", unit = "s" }
displacement = { column = "position_mm", unit = "mm" }
force = { column = "force_N", unit = "N" }
"""
# Columns, kind, further keys, files, and words of the remarks on the first file.
SETS = {
    "seal": (SEAL, "loop", "", [f"pneumatic-seal/Circle_{bar}bar.csv" for bar in (1, 3, 5, 7)], "scatter"),
    "dyno": (
        DYNO,
        "loop",
        "",
        [f"damper-dyno/t1_{name}psi.csv" for name in ("1_1_18_18_s5_n10_50", "2_2_24_24_s5_n10_100")],
        "",
    ),
    "rack": (
        RACK.replace("a3MR", f"{REAL}/rack-pinion/a3MR"),
        "transient",
        "",
        ["rack-pinion/a3NI.csv"],
        "1500 Hz",
    ),
    "torsion": (TORSION, "transient", "", ["torsion-oscillator/free-decays.csv"], "decimal commas"),
    "torsion, magnet": (
        TORSION,
        "transient",
        "",
        ["torsion-oscillator/free-decays-with-magnet.csv"],
        "decimal commas",
    ),
    "spring": (
        SPRING,
        "transient",
        "",
        [f"spring-mass/experiment_{i}.csv" for i in (1, 2, 3)],
        "data from line 1",
    ),
    "frame": (FRAME, "transient", "", ["frame-250g.csv", "frame-450g.csv"], ""),
    "emps": (EMPS, "loop", "", ["emps.csv"], ""),
}


@pytest.mark.parametrize("name", SETS)
def test_each_set_is_read_as_delivered(tmp_path, name):
    columns, kind, keys, files, words = SETS[name]
    force = 'excitation = "force"\namplitude_N = 1.0' if name == "rack" else "amplitude_mm = 1.0"
    model = ROTOR if columns is TORSION else MODEL.replace("amplitude_mm = 1.0", force)
    (tmp_path / "model.toml").write_text(model)
    tests = (f'[[measurement.test]]\nfile = "{REAL / file}"\nkind = "{kind}"\n{keys}' for file in files)
    text = f'[measurement]\nmodel = "model.toml"\n[measurement.columns]{columns}{"".join(tests)}'
    (tmp_path / "measured.toml").write_text(text)
    found = measured.read(tmp_path / "measured.toml")
    assert len(found.tests) == len(files)
    for test in found.tests:
        assert all(np.isfinite(samples).all() for samples in test.channels.values())
    assert words in "; ".join(found.tests[0].remarks)


def test_ten_runs_side_by_side_are_ten_tests(tmp_path):
    (tmp_path / "model.toml").write_text(ROTOR)
    tests = "".join(
        f'[[measurement.test]]\nfile = "{REAL}/torsion-oscillator/free-decays.csv"\nkind = "transient"\n'
        f'columns.time.column = "Time (s) Run #{run}"\n'
        f'columns.displacement.column = "Angle, Ch 1+2 (rad) Run #{run}"\n'
        for run in range(1, 11)
    )
    text = f'[measurement]\nmodel = "model.toml"\n[measurement.columns]{TORSION}{tests}'
    (tmp_path / "measured.toml").write_text(text)
    found = measured.read(tmp_path / "measured.toml")
    assert len(found.tests) == 10
    assert all(test.sampling_rate == pytest.approx(20.0) for test in found.tests)


# What is said of each small set that was made worse in one way: refused with these words, or read with them.
SMALL = {
    "delay-loop": (True, "force seems to be late by 0.9"),
    "delay-steady": (True, "delay_ms = -4.0"),
    "excel-days": (False, 'looks like days of Excel; write unit = "excel"'),
    "force-negated-one-loop": (True, "test-01.csv: force gives out energy"),
    "input-negated": (True, "write sign = -1 at input in [measurement.columns]"),
    "iso-time": (True, "time stamps are dates"),
    "jitter": (True, "time stamps scatter by 2.7 % of a step"),
    "lost-sample": (False, "a step of phase of 6.3 degrees near 0.49"),
    "nan-outside-selection": (True, "0.7925 s of 1.19"),
    "stated-amplitude-sign": (
        True,
        "test-01.csv, test-03.csv, test-05.csv: the second harmonic has the other",
    ),
    "two-rates": (True, "of input (recorded at 2000 Hz)"),
    "units-row-unknown": (False, 'displacement: the file says "in", its unit is stated as "mm"'),
}


@pytest.mark.parametrize("name", SMALL)
def test_what_is_wrong_with_a_set_is_told(name):
    valid, words = SMALL[name]
    told = invoke("check", REAL / "small" / name / "measured.toml", code=0 if valid else 2)
    assert words in told
    assert ("valid" in told) == valid


def copied(directory, name, *changes):
    """A small set with changes of its measured.toml."""
    for file in (REAL / "small" / name).iterdir():
        (directory / file.name).write_bytes(file.read_bytes())
    path = directory / "measured.toml"
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("delay-steady", ('column = "u"', 'column = "u"\ndelay_ms = -4.0')),
        ("delay-loop", ('column = "F"', 'column = "F"\ndelay_ms = 1.0')),
        ("input-negated", ('column = "u"', 'column = "u"\nsign = -1')),
        ("force-negated-one-loop", ('file = "test-01.csv"', 'file = "test-01.csv"\ncolumns.force.sign = -1')),
    ],
)
def test_the_line_that_is_named_mends_it(tmp_path, name, change):
    assert "warning" not in invoke("check", copied(tmp_path, name, change))


def test_rests_of_an_exact_displacement_do_not_count(tmp_path):
    path = copied(tmp_path, "loop-exact-rests")
    effects = "viscous_damping,stribeck"
    told = invoke("diagnose", path, "-o", tmp_path / "out", "--no-report", "--effects", effects)
    assert "Nothing is missing" in told


def test_days_are_read_as_days(tmp_path):
    path = copied(tmp_path, "excel-days", ('unit = "s"', 'unit = "excel"'))
    days = measured.read(path).tests[0]
    assert days.time[0] == pytest.approx(0.0, abs=1e-6)
    assert days.sampling_rate == pytest.approx(400.0, rel=1e-4)
