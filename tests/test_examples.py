"""The measured example: valid as it stands, and its hidden cause is found."""

import json
from pathlib import Path

from tests.command import invoke

EXAMPLES = Path(__file__).parents[1] / "examples"
MEASURED = EXAMPLES / "bench" / "measured.toml"
# Few candidates, as a test of the search itself is elsewhere.
CANDIDATES = "guide_friction,input_distortion,fixture_resonance"


def test_the_example_is_valid():
    assert "tests: 10" in invoke("check", MEASURED)


def test_its_hidden_cause_is_found(tmp_path):
    invoke("diagnose", MEASURED, "--effects", CANDIDATES, "--no-report", "-o", tmp_path / "result")
    found = json.loads((tmp_path / "result" / "diagnosis.json").read_text())
    truth = json.loads((EXAMPLES / "bench" / "truth.json").read_text())["effects"]["fixture_resonance"]
    assert found["verdict"] == "named"
    (cause,) = found["causes"]
    assert cause["effect"] == "fixture_resonance"
    for key, number in cause["parameters"].items():
        low, high = number["ci95"]
        assert low <= truth[key] <= high
