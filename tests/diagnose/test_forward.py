"""Effects that are added one at a time are the hidden ones, and the tests left out end it."""

import pytest

from tests.diagnose.synthetic import LAG, drawn, searched
from wedgesweep.diagnose.cross_validation import Predictor
from wedgesweep.diagnose.explanation import Explanation
from wedgesweep.diagnose.ladder import forward_selection, ladder
from wedgesweep.diagnose.least_squares import minimise

CANDIDATES = ("velocity_lag", "displacement_gain", "bolster_mass", "bolster_stiffness")
TWO = {**LAG, "displacement_gain": {"scale": 1.04}}
THREE = {**TWO, "bolster_mass": {"scale": 1.05}}


def levels_after(hidden, pair):
    """Levels before and after the selection, from the fit of a pair of effects."""
    search, base, singles = searched(drawn(hidden, std=1e-3, level=0.01), *CANDIDATES)
    known = {each.effects[0]: each.fit for each in singles}
    model = search.model(*pair)
    start = model.start(base.fit, [known[name].x[0] for name in pair])
    both = Explanation(minimise(model, model.evaluate(start)))
    predict = Predictor(search.each)
    before = ladder(search, base, [*singles, both], predict)
    return before, forward_selection(search, singles, before, predict)


@pytest.mark.acceptance
def test_the_third_of_three_effects_is_added_and_no_fourth():
    before, after = levels_after(THREE, ("velocity_lag", "bolster_mass"))
    assert [len(level.best.effects) for level in after] == [0, 1, 2, 3]
    assert after[:3] == before
    assert set(after[3].best.effects) == set(THREE)
    assert after[3].best.accuracy == 0.0
    assert after[3].best.held_out < 0.5 * before[2].best.held_out


@pytest.mark.acceptance
def test_nothing_is_added_to_the_whole_truth():
    before, after = levels_after(TWO, tuple(TWO))
    assert after == before


@pytest.mark.acceptance
def test_a_pair_that_predicts_no_better_than_one_effect_is_no_ground_to_build_on():
    before, after = levels_after(LAG, ("velocity_lag", "bolster_mass"))
    assert after == before
