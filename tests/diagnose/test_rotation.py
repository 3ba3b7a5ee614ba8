"""A pendulum from its files to the answer: units of a rotation everywhere, and the torque that was hidden."""

import json
from pathlib import Path

import pytest

from tests.command import invoke
from tests.diagnose.rigs import HEAD, PLACE, TEST

PENDULUM = """
[oscillator]
motion = "rotation"
inertia_kg_m2 = 0.02
spring_N_m_per_rad = 0.4
restoring_force = "pendulum"
contact = "ground"
[sweep]
friction_law = "coulomb"
frequency_hz = 1.0
amplitude_deg = 10.0
"""
HIDDEN = "[effects.guide_friction]\nforce_N_m = 0.012\n"
RELEASE = '[[test]]\nkind = "transient"\nrelease_deg = {}\nduration_s = 5.0\n'


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """A measurement of three releases, from large angles."""
    (tmp_path / "truth.toml").write_text(PENDULUM + HIDDEN)
    (tmp_path / "tests.toml").write_text("".join(map(RELEASE.format, (70.0, -50.0, 40.0))))
    made = ("--level", "0.001", "--sampling-hz", "100")
    invoke(
        "synthesize",
        tmp_path / "truth.toml",
        "--tests",
        tmp_path / "tests.toml",
        "-o",
        tmp_path / "made",
        *made,
    )
    return tmp_path / "made"


@pytest.mark.acceptance
def test_friction_of_a_pendulum_is_found_in_its_units(files: Path) -> None:
    measured = (files / "measured.toml").read_text()
    assert 'unit = "mrad"' in measured
    table = invoke("check", files / "measured.toml")
    assert "mrad" in table
    assert " mm" not in table
    only = ("--effects", "guide_friction,viscous_damping,cubic_stiffness")
    invoke("diagnose", files / "measured.toml", "-o", files / "out", *only)
    found = json.loads((files / "out" / "diagnosis.json").read_text())
    assert found["causes"], found["candidates"]
    (cause,) = found["causes"]
    assert (found["verdict"], cause["effect"]) == ("named", "guide_friction")
    low, high = cause["parameters"]["force_N_m"]["ci95"]
    assert low < 0.012 < high
    assert abs(found["misfit"]["tests"][0]["start_rad"]) == pytest.approx(1.22, abs=0.02)
    assert "force_N_m = " in (files / "out" / "extended.toml").read_text()
    report = (files / "out" / "report.html").read_text()
    assert "0.012" in report
    assert " mm" not in report


def test_lengths_of_a_rotation_are_refused(tmp_path: Path) -> None:
    (tmp_path / "model.toml").write_text(PENDULUM)
    (tmp_path / "decay.csv").write_text("t,x\n" + "".join(f"{0.01 * i},{i % 7}\n" for i in range(300)))
    (tmp_path / "wrong.toml").write_text(HEAD + PLACE + TEST.format("decay"))
    answer = invoke("check", tmp_path / "wrong.toml", code=2)
    assert "mm is not a unit of an angle or a torque" in answer
