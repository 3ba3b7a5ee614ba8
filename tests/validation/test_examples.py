"""Measurements from an independent simulator come out right (../shared/blind-examples, where it is there)."""

import json
from pathlib import Path

import pytest

from tests.validation.laboratory import diagnose

EXAMPLES = Path(__file__).parents[3] / "shared" / "blind-examples"
TRUTH = json.loads((EXAMPLES / "truth.json").read_text()) if EXAMPLES.is_dir() else {}
ABSTAINING = {"none-of-mine", "tied", "data-insufficient"}


def test_examples_are_there():
    if not TRUTH:
        pytest.skip(f"no examples at {EXAMPLES}")
    assert all((EXAMPLES / name / "measured.toml").exists() for name in TRUTH)


@pytest.mark.parametrize("name", sorted(TRUTH))
def test_example_comes_out_right(name, tmp_path):
    truth = TRUTH[name]
    found = diagnose(EXAMPLES / name / "measured.toml", tmp_path / "found")
    hidden = set(truth["truth"])
    if truth["kind"] == "clean":
        assert found.verdict == "nothing-missing"
    elif truth["kind"] == "unknown":
        assert found.verdict == "none-of-mine"
    elif truth["kind"] == "poor":
        assert found.verdict in ABSTAINING or found.causes == hidden
    else:
        assert found.verdict in ("named", "consistent-with") or found.verdict == "tied"
        assert hidden in found.explanations
        assert found.verdict == "tied" or found.causes == hidden
