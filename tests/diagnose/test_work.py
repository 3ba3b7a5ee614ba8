"""A search spends its budget in an order of its own, whatever the machine and the number of threads."""

import time
from dataclasses import replace
from itertools import combinations
from types import SimpleNamespace

import pytest

from tests.diagnose.synthetic import drawn
from wedgesweep.diagnose import pairs, stages, work
from wedgesweep.diagnose.search import Search, base_fit, single_fits
from wedgesweep.diagnose.work import Budget

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
    # What was left out once and tried another time was tried.
    assert search.budget.never_tried == tuple(item.effects for item in items[3:])


def test_a_grant_adds_what_is_missing_and_no_more():
    budget = Budget(100.0)
    work.add(70.0)
    budget.grant(20.0)
    assert budget.left == 30.0
    work.add(70.0)
    budget.grant(20.0)
    assert budget.left == 20.0


def test_a_simulated_case_counts_with_its_periods():
    search = Search.of(drawn(PAIR), CANDIDATES)
    begun = work.done()
    model = search.model()
    model.evaluate(model.start(None, model.low))
    assert search.data.tests < work.done() - begun < 100 * search.data.tests


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
        found = pairs.fit_pairs(search, base.fit, singles, scans)
        effects = [(each.effects, each.fit.chi2) for each in found]
        return effects, search.budget.untried, work.done() - begun, search.budget.changes

    complete = searched(1, float("inf"))
    assert complete[1] == []
    some = searched(1, 0.1 * complete[2])
    assert some[1]
    assert some[2] < complete[2]
    assert searched(2, 0.1 * complete[2]) == some
