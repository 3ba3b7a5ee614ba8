"""Data sets of an independent simulator, beside the checkout where they are there."""

import json
from pathlib import Path

from tests.validation.laboratory import diagnose
from wedgesweep.validation.judge import ABSTAINING, NAMING

EXAMPLES = Path(__file__).parents[3] / "shared" / "blind-examples"
TRUTH = json.loads((EXAMPLES / "truth.json").read_text()) if EXAMPLES.is_dir() else {}
# Those that a test run has time for: nothing hidden, and one effect.
QUICK = ("set-017", "set-052")


def comes_out_right(name, folder):
    """Diagnose an example and compare the answer with its truth."""
    truth = TRUTH[name]
    found = diagnose(EXAMPLES / name / "measured.toml", folder / "found")
    hidden = set(truth["truth"])
    if truth["kind"] == "clean":
        assert found.verdict == "nothing-missing"
    elif truth["kind"] == "unknown":
        assert found.verdict == "none-of-mine"
    elif truth["kind"] == "poor":
        assert found.verdict in ABSTAINING or found.causes == hidden
    else:
        assert found.verdict in NAMING or found.verdict == "tied"
        assert hidden in found.explanations
        assert found.verdict == "tied" or found.causes == hidden
