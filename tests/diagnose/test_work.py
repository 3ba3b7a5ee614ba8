"""A search spends its budget in an order of its own; its stages tell what they changed."""

import time
from dataclasses import replace
from itertools import combinations
from math import inf
from types import SimpleNamespace

import pytest

from tests.diagnose.synthetic import drawn
from wedgesweep.ablation import without
from wedgesweep.diagnose import pairs, stages, work
from wedgesweep.diagnose.search import Search, base_fit, single_fits
from wedgesweep.diagnose.work import Best, Budget, Change, summary

# More preload and less friction: no single effect explains both.
PAIR = {"preload": {"force": 0.3}, "friction_level": {"scale": 0.85}}
CANDIDATES = (*PAIR, "bolster_mass")


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_what_is_affordable_does_not_depend_on_which_thread_is_faster(threads):
    items = [SimpleNamespace(effects=(f"effect {i}", "another")) for i in range(8)]

    def worked(item):
        time.sleep(0.02 * (item is items[0]))
        work.add(10.0)
        return item

    search = Search(None, (), threads=threads, budget=Budget(25.0))
    begun = work.done()
    assert search.each_affordable(worked, items, "numbers") == items[:3]
    assert work.done() - begun == 30.0
    assert search.budget.left == -5.0
    assert search.each_affordable(worked, items[:2], "more numbers") == []
    assert search.each(worked, items[:2]) == items[:2]
    assert [each[:3] for each in search.budget.untried] == [("numbers", 5, 8), ("more numbers", 2, 2)]
    assert {each.ended_by for each in search.budget.untried} == {work.SPENT}
    # What was left out once and tried another time was tried.
    assert search.budget.never_tried == tuple(item.effects for item in items[3:])


def test_a_simulated_case_counts_with_its_periods_and_a_grant_adds_what_is_missing():
    search = Search.of(drawn(PAIR), CANDIDATES)
    begun = work.done()
    model = search.model()
    model.evaluate(model.start(None, model.low))
    assert search.data.tests < work.done() - begun < 100 * search.data.tests
    budget = Budget(100.0)
    for left in (30.0, 20.0):
        work.add(70.0)
        budget.grant(20.0)
        assert budget.left == left


def test_without_work_left_singles_are_fitted_and_the_rest_is_told():
    search = replace(Search.of(drawn(PAIR), CANDIDATES), budget=Budget(0.0))
    found = stages.explain(search)
    assert {each.effects for each in found.explanations} == {(name,) for name in CANDIDATES}
    left_out = {each.what: each.left_out for each in search.budget.untried}
    assert left_out == {pairs.PAIRS: 6}
    never = search.budget.never_tried
    assert set(map(frozenset, never)) == set(map(frozenset, combinations(CANDIDATES, 2)))


@pytest.mark.acceptance
def test_a_budget_ends_the_search_for_pairs_at_the_same_place_with_any_number_of_threads():
    def searched(threads, total):
        search, base, singles, scans = single_fits(base_fit(Search.of(drawn(PAIR), CANDIDATES, threads)))
        search = replace(search, budget=Budget(total))
        begun = work.done()
        found = pairs.fit_pairs(search, base, singles, scans)
        effects = [(each.effects, each.chi2) for each in found]
        return effects, search.budget.untried, work.done() - begun, search.budget.changes

    complete = searched(1, float("inf"))
    assert complete[1] == []
    some = searched(1, 0.1 * complete[2])
    assert some[1]
    assert some[2] < complete[2]
    assert searched(2, 0.1 * complete[2]) == some


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
