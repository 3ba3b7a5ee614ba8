"""A cause that is hidden in tests of a full-size suspension is named, as on the bench."""

import json
from pathlib import Path

import pytest

from tests.command import invoke
from wedgesweep import toml
from wedgesweep.config import load
from wedgesweep.natural_units import FREQUENCY, LENGTH

BOGIE = Path(__file__).parents[1] / "configs" / "bogie.toml"
# Below and above resonance (Hz, mm).
TESTS = ((0.85, 35.0), (1.37, 22.0), (1.88, 8.0), (3.27, 4.2), (4.05, 3.1), (5.25, 2.2))
FORCE, STD = 1000.0, 0.005
# Few candidates, as a test of the search itself is elsewhere.
CANDIDATES = "preload,viscous_damping,guide_friction,end_stop,velocity_lag"


def test_the_config_is_that_of_the_bench_at_another_size():
    units = load(BOGIE).natural_units()
    assert units.ratio(LENGTH) == pytest.approx(36.0, rel=1e-3)
    assert units.ratio(FREQUENCY) == pytest.approx(1.0 / 6.0, rel=1e-3)


def test_guide_friction_of_a_thousand_newtons_is_named(tmp_path):
    document = load(BOGIE).document
    document["effects"] = {"guide_friction": {"force_N": FORCE}}
    document["sweep"] |= {"friction_law": ["static-dynamic"]}
    tests = [{"frequency_hz": f, "amplitude_mm": a, "amplitude_std": STD} for f, a in TESTS]
    (tmp_path / "true.toml").write_text(toml.dumps(document))
    (tmp_path / "tests.toml").write_text(toml.dumps({"test": tests}))
    invoke("synthesize", tmp_path / "true.toml", "--tests", tmp_path / "tests.toml", "-o", tmp_path / "data")
    measured, result = tmp_path / "data" / "measured.toml", tmp_path / "result"
    invoke("diagnose", measured, "--effects", CANDIDATES, "--no-report", "-o", result)
    found = json.loads((result / "diagnosis.json").read_text())
    assert found["verdict"] == "named"
    (cause,) = found["causes"]
    assert cause["effect"] == "guide_friction"
    low, high = cause["parameters"]["force_N"]["ci95"]
    assert low <= FORCE <= high
    assert high - low < 0.2 * FORCE
