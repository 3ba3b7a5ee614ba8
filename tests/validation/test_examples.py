"""Examples of an independent simulator come out right; ``make validate`` runs all of them."""

import pytest

from tests.validation import examples
from tests.validation.laboratory import diagnose


@pytest.mark.acceptance
@pytest.mark.skipif(not examples.TRUTH, reason="no ../shared/blind-examples beside the checkout")
@pytest.mark.parametrize("name", examples.QUICK)
def test_an_example_comes_out_right(name, tmp_path):
    examples.comes_out_right(name, tmp_path, examples.CANDIDATES)


@pytest.mark.acceptance
@pytest.mark.skipif(not examples.HARD_TRUTH, reason="no ../shared/hard-examples beside the checkout")
def test_a_pair_with_a_local_minimum_is_named(tmp_path):
    """The search for pairs once got it wrong."""
    file = examples.HARD_EXAMPLES / "pair-126" / "measured.toml"
    found = diagnose(file, tmp_path / "found", examples.CANDIDATES, "--no-report")
    truth = examples.HARD_TRUTH["pair-126"]
    assert found.verdict == "named"
    assert found.causes == set(truth["truth"])
    assert not found.document["untried"]
    for name, value in truth["values"].items():
        low, high = found.parameters[name]["ci95"]
        assert low - (high - low) < value < high + (high - low)
