"""A planted effect is found through the command line; where nothing is planted, nothing is named.

``make validate`` runs many more of these (``diagnoses.py``, and the campaign with every effect).
"""

from dataclasses import replace

import pytest

from tests.validation import checks
from tests.validation.laboratory import BENCH, CLEAN, GUIDE_FRICTION, PAPER_TESTS, diagnose, make
from wedgesweep.diagnosis_result import DATASET, EXTENDED, JSON

# Every second test: Radau takes longer over the data than the diagnosis does.
FEW = BENCH[::2]
CANDIDATES = ["guide_friction", "viscous_damping", "stribeck", "displacement_gain", "bolster_stiffness"]


def test_a_strong_cause_is_named_with_its_numbers(tmp_path):
    checks.strong_cause_is_named(replace(GUIDE_FRICTION, tests=FEW), tmp_path, CANDIDATES)


def test_in_clean_data_nothing_is_named(tmp_path):
    measured, _ = make(replace(CLEAN, tests=FEW), tmp_path)
    found = diagnose(measured, tmp_path / "found", CANDIDATES)
    assert found.verdict == "nothing-missing"
    assert found.document["causes"] == []
    assert (found.directory / "report.html").exists()
    again = diagnose(measured, found.directory, ["displacement_gain"], "--no-report")
    assert len(again.document["candidates"]) < len(found.document["candidates"])
    assert {file.name for file in again.directory.iterdir()} == {JSON, DATASET, EXTENDED}


@pytest.mark.acceptance
def test_two_tests_of_unknown_amplitude_ask_for_a_third(tmp_path):
    measured, _ = make(PAPER_TESTS, tmp_path)
    found = diagnose(measured, tmp_path / "found", CANDIDATES, "--no-report")
    assert found.verdict in ("data-insufficient", "tied")
    following = found.document["next_test"]
    assert following["frequency_hz"] > 0.0
    assert following["amplitude_mm"] > 0.0
