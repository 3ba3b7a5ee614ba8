"""Data sets of an independent simulator, beside the checkout where they are there."""

import json
from pathlib import Path

from validation.judge import ABSTAINING, NAMING

from tests.validation.laboratory import diagnose

SHARED = Path(__file__).parents[3] / "shared"
EXAMPLES, HARD_EXAMPLES = SHARED / "blind-examples", SHARED / "hard-examples"


def _truth(folder):
    return json.loads((folder / "truth.json").read_text()) if folder.is_dir() else {}


TRUTH, HARD_TRUTH = _truth(EXAMPLES), _truth(HARD_EXAMPLES)
IMPERFECT = sorted(name for name, truth in HARD_TRUTH.items() if truth["kind"] == "imperfect")
# Causes that are hidden in examples of the test run, and what comes close to them.
OF_FRICTION = ("ageing", "friction_level", "stribeck")
CANDIDATES = (
    *("friction_level", "stribeck", "guide_friction", "column_compliance", "fixture_resonance"),
    *("displacement_gain", "velocity_lag"),
)
# That which a test run has time for, with one effect; sets with none are made in test_planted_effects.py.
QUICK = ("set-052",)


def comes_out_right(name, folder, candidates=None):
    """Diagnose an example and compare the answer with its truth."""
    found = diagnose(EXAMPLES / name / "measured.toml", folder / "found", candidates, "--no-report")
    truth = TRUTH[name]
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
