"""Benches with small errors everywhere beside one strong cause, where they are at hand."""

import json
import shutil

import pytest

from tests.validation.examples import HARD_EXAMPLES, HARD_TRUTH, OF_FRICTION
from wedgesweep import api

pytestmark = [
    pytest.mark.acceptance,
    pytest.mark.skipif(not HARD_TRUTH, reason="no ../shared/hard-examples beside the checkout"),
]


@pytest.mark.parametrize(("name", "reason"), [("ageing-022", "more-accurate"), ("friction-054", "at-limit")])
def test_the_right_cause_is_told_beside_a_misfit(name, reason):
    measurement = api.read_measurement(HARD_EXAMPLES / name / "measured.toml")
    found = api.diagnose_measurement(measurement, effects=OF_FRICTION, n_jobs=1)
    assert (found.verdict, found.document["reason"]["code"]) == ("consistent-with", reason)
    assert [each["effect"] for each in found.causes] == HARD_TRUTH[name]["truth"]


def test_the_cause_is_told_and_leads_the_ladder_though_no_model_is_right(tmp_path):
    """A model error of 2 % is declared; ``make validate`` has 53 such benches."""
    shutil.copytree(HARD_EXAMPLES / "imperfect-1", tmp_path / "made")
    file = tmp_path / "made" / "measured.toml"
    file.write_text(file.read_text().replace("[measurement]\n", "[measurement]\nmodel_error = 0.02\n", 1))
    candidates = ("guide_friction", "fixture_resonance", *OF_FRICTION[1:])
    document = api.diagnose_measurement(api.read_measurement(file), effects=candidates, n_jobs=1).document
    assert document["verdict"] in ("named", "consistent-with")
    assert [each["effect"] for each in document["causes"]] == ["guide_friction"]
    base, single = document["ladder"][:2]
    assert (base["effects"], single["effects"]) == ([], ["guide_friction"])
    assert single["accuracy"] < 0.02 < base["accuracy"]
    assert single["distinct"] > 1.0
    assert json.dumps(document, allow_nan=False)
