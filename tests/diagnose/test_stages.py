"""Every stage of a search tells what it changed, and can be left out."""

from math import inf

from tests.diagnose.synthetic import drawn
from wedgesweep.ablation import without
from wedgesweep.diagnose import stages
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.work import Best, Change, summary

# It is no candidate.
HIDDEN = {"bolster_mass": {"scale": 1.05}}


def searched():
    return stages.explain(Search.of(drawn(HIDDEN), ("displacement_gain", "velocity_lag")))


def test_stages_tell_what_they_changed_and_can_be_left_out():
    known = searched()
    told = {row["stage"]: row for row in summary(known.search.budget.changes)}
    assert {"best pairs", "base model again"} <= told.keys()
    assert told["best pairs"]["work"] > 0.0
    assert ("displacement_gain", "velocity_lag") in [each.effects for each in known.explanations]
    with without("best pairs", "base model again"):
        known = searched()
    assert not {"best pairs", "base model again"} & {each.stage for each in known.search.budget.changes}
    assert {len(each.effects) for each in known.explanations} == {1}


def test_the_summary_counts_fits_that_got_better():
    one, far = Best(("preload",), 10.0), Best(("preload",), 25.0)
    changes = [Change("a", far, one, 2.0), Change("a", one, one, 1.0), Change("b", Best((), inf), far, 1.0)]
    found = summary(changes)
    assert found[0] == {
        **{"stage": "a", "taken": 2, "better": 1, "most_gained": 15.0, "best": ["preload"], "work": 3.0}
    }
    assert (found[1]["better"], found[1]["most_gained"]) == (1, None)
