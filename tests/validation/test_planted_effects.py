"""A planted effect is found through the command line; where nothing is planted, nothing is named.

``make validate`` runs many more of these (``diagnoses.py``, and the campaign with every effect).
"""

from dataclasses import replace

import pytest

from tests.validation import checks
from tests.validation.laboratory import BENCH, CLEAN, PAPER_TESTS, Specimen, diagnose, make
from wedgesweep.diagnosis_result import DATASET, EXTENDED, JSON

# Every second test: Radau takes longer over the data than the diagnosis does. No effect here has mechanics of
# its own, which would have to be compiled twice.
FEW = BENCH[::2]
GAIN = Specimen("gain", "static-dynamic", {"displacement_gain": {"scale": 1.15}}, "ar1", tests=FEW)
CANDIDATES = ["displacement_gain", "bolster_stiffness", "bolster_mass", "friction_level", "preload"]


@pytest.mark.acceptance
def test_a_strong_cause_is_named_with_its_numbers(tmp_path):
    checks.strong_cause_is_named(GAIN, tmp_path, CANDIDATES)


@pytest.mark.acceptance
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
