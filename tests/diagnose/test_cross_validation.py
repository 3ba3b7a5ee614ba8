"""Gain on tests that a fit has not seen; effects are added one at a time until these tests end it."""

import numpy as np
import pytest

from tests.diagnose.synthetic import LAG, base_of, drawn, lagging, searched
from wedgesweep.diagnose import accuracy, cross_validation
from wedgesweep.diagnose.cross_validation import Gain, Predictor
from wedgesweep.diagnose.ladder import forward_selection, ladder
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.steady import harmonic_data, tone

POINTS = 32


def serial(function, items):
    return list(map(function, items))


def gain_of(squares):
    """Gain over tests that were left out one by one, by what base and extended model and noise leave."""
    count = len(squares)
    return Gain(("test",) * count, np.arange(count), np.full(count, POINTS), np.array(squares))


def test_gain_on_held_out_tests_reaches_the_noise():
    _, base, lag = lagging()
    measured = cross_validation.cross_validate(base, lag, Predictor(serial))
    assert set(measured.schemes) == {"frequency", "amplitude"}
    assert measured.excess_removed > 0.95
    assert measured.interval is None  # six tests are too few for one


def test_less_error_than_is_allowed_is_no_excess():
    """Under a model error that is far from used up, all of the excess is gone, and no more than that."""
    gain = gain_of([(400.0 + 40.0 * i, 10.0, 98.0) for i in range(10)])
    assert gain.excess_removed == 1.0
    assert gain.interval == [1.0, 1.0]


@pytest.mark.acceptance
def test_what_a_test_tells_of_its_own_amplitude_is_not_left_as_noise():
    """Squared misfit of a right model, less what noise should leave."""
    for std, known, least, most in ((1e-5, True, 1.0, 1.05), (0.5, True, 1.9, 2.0), (0.0, False, 2.0, 2.0)):
        left = []
        for seed in range(12):
            _, base, _ = searched(drawn(seed=seed, std=std, known=known))
            local = cross_validation.local_numbers(base)
            assert ((least <= local) & (local <= most)).all()
            left.append((base.evaluation.residual**2).sum() - (base.model.data.observations - local).sum())
        assert np.mean(left) == pytest.approx(0.0, abs=3.0 * np.sqrt(2.0 * 384 / 12))


def test_retuning_alone_gains_nothing():
    _, base, (lag,) = searched(drawn(), "velocity_lag")
    measured = cross_validation.cross_validate(base, lag, Predictor(serial))
    base_square, extended, noise = measured.mean_squares()
    assert extended == pytest.approx(base_square, rel=0.02)
    assert base_square == pytest.approx(noise, rel=0.2)


@pytest.mark.acceptance
def test_a_cause_that_only_the_test_left_out_shows_predicts_nothing():
    """An end stop that one test touches: without this test its clearance and stiffness may be anything."""
    data = drawn({"end_stop": {"clearance": 3.6e-4, "stiffness": 2e5}}, std=0.015)
    _, base, (stop,) = searched(data, "end_stop")
    left = base.evaluation.chi2_by_test - stop.evaluation.chi2_by_test
    assert np.flatnonzero(left > 100.0).tolist() == [3]
    measured = cross_validation.cross_validate(base, stop, Predictor(serial))
    assert measured.excess_removed == pytest.approx(0.0, abs=1e-3)
    found, nothing = (cross_validation.held_out_accuracy(fit, Predictor(serial)) for fit in (stop, base))
    assert found == pytest.approx(nothing, rel=1e-2)


def test_a_model_that_fits_nothing_predicts_as_accurately_as_it_explains():
    base = base_of(drawn(LAG, std=0.0))
    data, evaluation = base.model.data, base.evaluation
    predicted = Predictor(serial)(base)
    assert np.bincount(np.concatenate([each.tests for each in predicted])).tolist() == [2] * 6
    # Each test is left out twice, and both times it is as it was; only start phases are eliminated.
    both = accuracy.of_responses([(data, evaluation)] * 2, 2 * base.dof)
    found = cross_validation.held_out_accuracy(base, Predictor(serial))
    assert found == pytest.approx(both, rel=1e-2)
    assert found == pytest.approx(accuracy.of_responses([(data, evaluation)], base.dof), rel=0.05)


def test_a_fit_is_predicted_once():
    base, calls = base_of(drawn(LAG)), []
    predict = Predictor(lambda function, items: calls.append(len(items)) or serial(function, items))
    assert predict(base) is predict(base)
    assert len(calls) == 1
    assert predict(base_of(drawn(LAG))) is not predict(base)


def test_tests_that_are_all_alike_are_left_out_one_by_one():
    data = drawn(tests=[2, 2])
    assert [(name, rows.tolist()) for name, rows in cross_validation.held_out_groups(data)] == [
        ("test", [0]),
        ("test", [1]),
    ]
    single = drawn(tests=[2])
    assert cross_validation.held_out_groups(single) == []
    assert cross_validation.held_out_accuracy(base_of(single), Predictor(serial)) is None


def predicted(*squares):
    """Gain over twelve tests: these (base, extended) and for the rest nothing that could be removed."""
    noise = np.random.default_rng(2).chisquare(POINTS - 1, 12 - len(squares))
    both = [*squares, *((q, q + 0.3) for q in noise)]
    return gain_of([(*each, POINTS - 1.0) for each in both])


def test_tests_in_which_nothing_shows_do_not_make_an_effect_uncertain_that_shows_in_few():
    low, high = predicted((6000.0, 42.0), (3200.0, 26.0), (210.0, 31.0)).interval
    assert 0.95 < low < high < 1.05


def test_an_effect_that_one_test_denies_is_uncertain():
    assert predicted((6000.0, 42.0), (3200.0, 6200.0), (210.0, 31.0)).interval[0] < 0.0
    assert predicted((300.0, 340.0)).interval[0] < 0.0


def test_a_fine_sweep_is_no_single_group():
    """Each frequency lies within 2 % of the next, not of all."""
    frequencies = np.arange(30.0, 38.1, 0.5)
    found = harmonic_data.groups_of_equal(frequencies[::-1].copy())
    assert sorted(np.concatenate(found).tolist()) == list(range(frequencies.size))
    assert max(np.ptp(np.log(frequencies[::-1][group])) for group in found) <= tone.SAME
    assert len(found) > 5


CANDIDATES = ("velocity_lag", "displacement_gain", "bolster_mass", "bolster_stiffness")
TWO = {**LAG, "displacement_gain": {"scale": 1.04}}
THREE = {**TWO, "bolster_mass": {"scale": 1.05}}


def levels_after(hidden, pair):
    """Levels before and after the selection, from the fit of a pair of effects."""
    search, base, singles = searched(drawn(hidden, std=1e-3, level=0.01), *CANDIDATES)
    known = {each.effects[0]: each for each in singles}
    model = search.model(*pair)
    start = model.start(base, [known[name].x[0] for name in pair])
    both = minimise(model, model.evaluate(start))
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
