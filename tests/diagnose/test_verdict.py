"""The six verdicts, from fits that are set by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from wedgesweep.diagnose import diagnosis, ladder, verdict
from wedgesweep.diagnose.explanation import POSSIBLE
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.ladder import Level, Rated
from wedgesweep.diagnose.model import IMPLAUSIBLE, Fit
from wedgesweep.diagnose.parameter_constancy import Constancy
from wedgesweep.diagnose.verdict import Thresholds, decide, on_held_out_tests, p_where_it_shows
from wedgesweep.diagnosis_result import Reason

DOF, MODEL_ERROR = 700, 0.02


def explained(
    q,
    *effects,
    tests=12,
    uncertain=None,
    values=None,
    numbers=1,
    by_test=None,
    constant=1.0,
    error=0.0,
    far=(),
    relaxed=None,
    power=100.0,
    vanishes=False,
    converged=True,
):
    """An explanation.

    ``values``: numbers of its effects; ``far``: uncertain ones that are far from stated; ``relaxed``: its
    misfit if model errors are larger than allowed; ``power``: of the response, over that of noise;
    ``vanishes``: whether it ended where its effect is as good as absent.
    """
    data = SimpleNamespace(
        model=SimpleNamespace(effects={}),
        tests=tests,
        uncertain=uncertain or {},
        dof=np.full(tests, DOF / tests),
        observations=np.full(tests, DOF / tests),
        power=np.full(tests, power * DOF / tests),
        model_misfit=np.full(tests, error * DOF / tests),
        model_error=0.0 if relaxed is None else MODEL_ERROR,
        with_model_error=lambda size: SimpleNamespace(
            compared_again=lambda evaluation: SimpleNamespace(chi2=relaxed if size > MODEL_ERROR else q)
        ),
    )
    model = SimpleNamespace(
        data=data,
        effects=effects,
        size=numbers * len(effects),
        dof=DOF,
        values=lambda x: values,
        hypothesis=SimpleNamespace(vanishes=lambda x: vanishes),
        uncertain=SimpleNamespace(numbers=[SimpleNamespace(effect=name) for name in far]),
    )
    evaluation = SimpleNamespace(
        chi2=q,
        chi2_by_test=np.full(tests, q / tests) if by_test is None else by_test,
        uncertain_prior=np.full(len(far), 2.0 * IMPLAUSIBLE),
        point=SimpleNamespace(x=None),
    )
    found = Fit(model, evaluation, None, converged)
    vars(found)["constancy"] = Constancy(constant, None)
    return found


def verdict_of(base, *others, thresholds=verdict.DEFAULT):
    return decide(base, others, thresholds)


@pytest.mark.parametrize(
    ("base", "stribeck", "preload", "tests", "expected"),
    [
        (715.0, 708.0, 712.0, 12, "nothing-missing"),
        (5000.0, 705.0, 2000.0, 12, "named"),
        (1000.0, 705.0, 800.0, 12, "consistent-with"),
        (5000.0, 705.0, 709.0, 12, "tied"),
        (5000.0, 705.0, 2000.0, 2, "data-insufficient"),
        (5000.0, 1500.0, 1600.0, 12, "none-of-mine"),
        (5000.0, 4999.0, 5000.0, 12, "none-of-mine"),
    ],
)
def test_evidence_decides(base, stribeck, preload, tests, expected):
    both = explained(stribeck, "stribeck", tests=tests), explained(preload, "preload", tests=tests)
    found = verdict_of(explained(base, tests=tests), *both)
    causes = ("named", "consistent-with", "tied")
    assert (found.verdict, found.cause) == (expected, both[0] if expected in causes else None)
    assert found.rivals == (both[1:] if expected == "tied" else ())


def test_a_model_error_may_be_larger_in_single_tests():
    """Errors of the model that are most of the variance scatter more than noise does."""
    loud = np.where(np.arange(12) < 2, 2000.0, 60.0)
    for q, error, least, most in (
        (1.0, 0.0, 0.0, 1.0),
        (2.0, 0.0, 0.0, 1e-6),
        (2.0, 0.95, 0.01, 0.5),
        (8.0, 0.95, 0.0, 1e-3),
    ):
        by_test = np.where(np.arange(12) < 2, q * DOF / 12, 30.0)
        base = explained(5000.0, by_test=loud, error=error)
        best = explained(600.0, "stribeck", by_test=by_test, error=error)
        assert least <= p_where_it_shows(base, best) <= most


def test_two_numbers_of_the_model_may_stand_for_a_third():
    """Masses, stiffnesses and forces mimic each other; a spring and a damper do not."""
    best = explained(705.0, "bolster_stiffness", "wedge_stiffness")
    found = verdict_of(explained(5000.0), best, explained(2000.0, "bolster_stiffness"))
    assert (found.verdict, found.cause, found.alternatives) == ("data-insufficient", None, (best,))
    best = explained(705.0, "bolster_stiffness", "viscous_damping")
    found = verdict_of(explained(5000.0), best, explained(2000.0, "bolster_stiffness"))
    assert (found.verdict, found.cause) == ("named", best)


@pytest.mark.parametrize(
    ("base", "constant", "expected"),
    [
        (5000.0, 0.02, "named"),
        (5000.0, 0.002, "consistent-with"),
        (5000.0, 1e-4, "none-of-mine"),
        (1000.0, 1e-4, "none-of-mine"),
    ],
)
def test_a_cause_has_the_same_numbers_in_all_tests(base, constant, expected):
    """What is left may be noise as a whole, and yet point the way in which they would have to differ."""
    best = explained(705.0, "friction_level", constant=constant)
    assert verdict_of(explained(base), best).verdict == expected


def test_what_has_not_is_no_rival_but_shows_that_others_imitate():
    best = explained(705.0, "bolster_mass")
    for constant, expected in ((0.5, "tied"), (1e-4, "consistent-with")):
        rival = explained(700.0, "bolster_stiffness", constant=constant)
        found = verdict_of(explained(5000.0), best, rival)
        assert (found.verdict, found.rivals) == (expected, (best if expected == "tied" else rival,))


def test_a_second_effect_that_hardly_shows_is_not_named():
    """Many effects fit a parameter that differs a little from test to test."""
    half = explained(760.0, "friction_level", constant=1e-4)
    pair = explained(690.0, "friction_level", "ageing")
    found = verdict_of(explained(5000.0), half, pair)
    assert (found.verdict, found.alternatives) == ("data-insufficient", (pair,))
    wrong = explained(2000.0, "friction_level")
    assert verdict_of(explained(5000.0), wrong, pair).verdict == "named"


def test_a_second_effect_that_may_be_an_error_of_the_model_is_no_cause():
    """How large model errors are is a guess: one effect alone would do if they were twice as large."""
    pair, base = explained(690.0, "bolster_mass", "cross_slip", relaxed=650.0), explained(5000.0)
    half = explained(1700.0, "bolster_mass", relaxed=720.0)
    found = verdict_of(base, half, pair)
    assert (found.verdict, found.cause, found.rivals) == ("consistent-with", half, (pair,))
    too_poor = explained(1700.0, "bolster_mass", relaxed=900.0)
    with_other_numbers = explained(1700.0, "bolster_mass", relaxed=720.0, far=("wedge_stiffness",))
    for half in (too_poor, with_other_numbers):
        assert verdict_of(base, half, pair).cause is pair


def test_a_cause_takes_something_off_though_others_that_do_not_qualify_take_more():
    refuted, idle = explained(690.0, "friction_level", constant=1e-4), explained(709.0, "preload")
    assert verdict_of(explained(715.0), refuted, idle).verdict == "none-of-mine"


def shared(there, elsewhere):
    """Squared misfits of two tests that show something, and of ten that do not."""
    return np.r_[np.full(2, there), np.full(10, elsewhere)]


def test_tests_that_show_nothing_cannot_make_up_for_a_misfit():
    """Over all tests it is noise, and in those that the cause is for it is not."""
    base = shared(2000.0, DOF / 12)
    start = explained(base.sum(), by_test=base)
    right, doubtful, wrong = shared(DOF / 12, DOF / 12), shared(82.0, 54.0), shared(120.0, 47.0)
    several = [explained(q.sum(), "stribeck", by_test=q) for q in (right, doubtful, wrong)]
    found = [verdict_of(start, each) for each in several]
    assert [each.verdict for each in found] == ["named", "consistent-with", "none-of-mine"]
    assert several[1].p > several[2].p > verdict.ADEQUATE
    # With a failure on held-out tests it leaves no cause.
    assert several[1].p > verdict.ADEQUATE > p_where_it_shows(start, several[1])
    unconfirmed = on_held_out_tests(found[1], start, 0.5, [-0.3, 1.0])
    assert (unconfirmed.verdict, unconfirmed.best) == ("none-of-mine", several[1])
    # Where nothing shows, all that is left counts.
    quiet = explained(600.0)
    assert p_where_it_shows(quiet, quiet) > 0.0


@pytest.mark.parametrize(
    ("q", "removed", "interval", "expected"),
    [
        (705.0, 0.98, [0.9, 1.02], "named"),
        (705.0, 0.5, [0.0, 1.0], "named"),
        (705.0, -0.1, None, "consistent-with"),
        (810.0, -0.1, None, "consistent-with"),
        (705.0, 0.5, [-0.3, 1.0], "consistent-with"),
        (810.0, 0.98, [0.9, 1.02], "consistent-with"),
        (825.0, 0.98, [0.9, 1.02], "none-of-mine"),
        (810.0, 0.5, [-0.3, 1.0], "none-of-mine"),
    ],
)
def test_a_cause_that_may_predict_held_out_tests_worse_is_none(q, removed, interval, expected):
    base, best = explained(5000.0), explained(q, "stribeck")
    found = on_held_out_tests(verdict_of(base, best), base, removed, interval)
    assert (found.verdict, found.best) == (expected, best)
    assert (found.cause is None) == (expected == "none-of-mine")


def test_what_held_out_tests_do_not_confirm_names_nothing():
    unsure = (0.5, [-0.3, 1.0])
    base, best, other = explained(5000.0), explained(690.0, "stribeck"), explained(720.0, "preload")
    for found in (verdict_of(explained(1200.0), best), verdict_of(base, best, other)):
        assert found.verdict == "consistent-with"
        found = on_held_out_tests(found, base, *unsure)
        assert (found.verdict, found.cause) == ("data-insufficient", None)
        assert found.alternatives[0] is best
    # The best one leaves a bit more than noise, a rival does not: that is not called none.
    best, rival = explained(793.0, "stribeck"), explained(787.0, "preload", "end_stop")
    found = verdict_of(base, best, rival)
    assert (found.verdict, found.best, found.rivals) == ("tied", best, (rival,))
    assert rival.p > verdict.ADEQUATE > best.p
    assert on_held_out_tests(found, base, *unsure).verdict == "data-insufficient"
    # A tolerable base model needs no such cause.
    base = explained(830.0)
    assert verdict.TOLERABLE < base.p < POSSIBLE
    found = verdict_of(base, explained(780.0, "stribeck"))
    assert found.verdict == "consistent-with"
    assert on_held_out_tests(found, base, *unsure).verdict == "nothing-missing"
    assert on_held_out_tests(found, base, 0.5, [0.1, 1.0]).verdict == "consistent-with"


def test_a_cause_removes_more_than_model_errors_and_chance_may_leave():
    """Model errors may have the shape of any effect; calibrated thresholds replace the general ones."""
    data = SimpleNamespace(model_misfit=np.full(12, 0.9 * DOF / 12))
    thresholds = verdict.thresholds_for(data)
    for base, best, expected in (
        (500.0, 60.0, "nothing-missing"),
        (1300.0, 700.0, "data-insufficient"),
        (5000.0, 300.0, "named"),
    ):
        found = verdict_of(explained(base), explained(best, "stribeck"), thresholds=thresholds)
        assert found.verdict == expected
    calibrated = verdict.thresholds_for(data, Thresholds(least_gain=2000.0))
    assert calibrated.least_gain == 2000.0
    assert verdict.thresholds_for(SimpleNamespace(model_misfit=np.zeros(12))) == verdict.DEFAULT
    base, best = explained(1000.0), explained(705.0, "stribeck")
    assert verdict_of(base, best, thresholds=Thresholds(strong=0.0)).verdict == "named"
    assert verdict_of(base, best, thresholds=Thresholds(least_gain=1000.0)).verdict != "named"
    # The base model will not do, and what will gains less than a clean draw may.
    base = explained(860.0)
    assert base.p < verdict.TOLERABLE
    assert verdict_of(base, best, thresholds=Thresholds(least_gain=200.0)).verdict == "data-insufficient"


def test_an_effect_that_is_as_good_as_absent_is_no_cause():
    base, absent = explained(700.0), explained(600.0, "damper_play", vanishes=True)
    assert verdict_of(base, absent).verdict == "nothing-missing"
    play = Hypothesis(("damper_play",))
    assert play.vanishes(play.low)
    assert not play.vanishes(play.low + 0.1)


FAR = ("bolster_mass",)
ALLOWED = Thresholds(least_gain=600.0)


def test_a_base_model_with_numbers_far_from_stated_lacks_something():
    """They make up for a cause that gains less than a model error may leave."""
    plausible = explained(560.0, "wedge_stiffness")
    others = explained(550.0, "stribeck", far=FAR), explained(900.0, "preload"), plausible
    found = verdict_of(explained(600.0, far=FAR), *others, thresholds=ALLOWED)
    assert (found.verdict, found.cause, found.alternatives) == ("data-insufficient", None, (plausible,))
    assert verdict_of(explained(600.0), *others, thresholds=ALLOWED).verdict == "nothing-missing"
    found = verdict_of(explained(600.0, far=FAR), *others[:2], thresholds=ALLOWED)
    assert (found.verdict, found.best) == ("none-of-mine", others[0])
    # Held-out tests do not make up for them.
    for far, expected in (((), "nothing-missing"), (FAR, "data-insufficient")):
        base, best = explained(700.0, far=far), explained(650.0, "stribeck")
        found = verdict_of(base, best)
        assert found.verdict == "consistent-with"
        assert on_held_out_tests(found, base, -0.1, (-0.2, 0.1)).verdict == expected


def test_a_pair_must_beat_its_parts_and_be_imitated_by_few():
    """As by a spring that is no candidate, to which many pairs come close."""
    base, single = explained(5000.0), explained(730.0, "stribeck")
    assert verdict_of(base, single, explained(716.0, "stribeck", "preload")).cause is single
    pair = explained(690.0, "stribeck", "preload")
    assert verdict_of(base, single, pair).cause is pair
    for others, expected in ((3, "consistent-with"), (4, "data-insufficient")):
        pair = explained(640.0, "bolster_mass", "viscous_damping")
        near = [explained(700.0 + i, "bolster_mass", name) for i, name in enumerate("abcd"[:others])]
        far = [explained(1000.0 + i, "bolster_mass", name) for i, name in enumerate("efghij")]
        found = verdict_of(base, pair, *near, *far)
        assert (found.verdict, len(found.rivals)) == (expected, others)
    # All of many equal ones are listed, the best first, even one that leaves a little more than noise.
    for least in (705.0, 800.0):
        equal = [explained(least + i, name) for i, name in enumerate("abcdef")]
        found = verdict_of(base, *equal)
        assert (found.verdict, found.alternatives) == ("data-insufficient", tuple(equal))


def test_a_cause_is_named_only_if_no_other_leaves_noise_only():
    """A mass that is no candidate, and a spring that does nearly the same."""
    base, best = explained(5000.0), explained(690.0, "bolster_stiffness")
    found = verdict_of(base, best, explained(720.0, "wedge_stiffness"), explained(900.0, "preload"))
    assert (found.verdict, found.cause) == ("consistent-with", best)
    assert [each.effects for each in found.rivals] == [("wedge_stiffness",)]
    # The cause itself with something beside it is no other.
    assert verdict_of(base, best, explained(685.0, "bolster_stiffness", "preload")).verdict == "named"


@pytest.mark.parametrize(
    ("name", "numbers", "named"),
    [
        ("friction_level", {"scale": 1.25}, False),
        ("friction_level", {"scale": 1.4}, True),
        # Of each harmonic, cosine and sine part have a share of 1 / sqrt(2).
        ("input_distortion", {"second": 0.2, "second_phase": 2.0, "third": 0.0, "third_phase": 0.0}, False),
        ("input_distortion", {"second": 0.0, "second_phase": 0.0, "third": 0.22, "third_phase": 3.1}, True),
    ],
)
def test_an_uncertain_number_is_a_cause_beyond_three_deviations(name, numbers, named):
    found = verdict_of(
        explained(5000.0), explained(705.0, name, uncertain={name: 0.1}, values={name: numbers})
    )
    assert (found.verdict == "named") is named


@pytest.fixture
def refit(monkeypatch):
    """Refits of a cause that change fits as told: the tight one, and the one that goes on."""

    def refit(base, finding, found, tight=lambda fit: fit, further=None):
        monkeypatch.setattr(diagnosis, "tight_refit", tight)
        monkeypatch.setattr(diagnosis, "minimise", lambda model, start: further)
        monkeypatch.setattr(diagnosis, "profile_likelihood", lambda fit, each: fit)
        search = SimpleNamespace(each=map)
        return diagnosis.refit_cause(search, base, finding, found, verdict.DEFAULT)

    return refit


def test_what_was_best_only_for_its_error_gives_way(refit):
    base, first, second = explained(5000.0), explained(705.0, "stribeck"), explained(709.0, "preload")
    worse = explained(900.0, "stribeck")
    tied = verdict_of(base, first, second)
    assert tied.verdict == "tied"
    found, order = refit(base, tied, [first, second], lambda fit: worse if fit is first else fit)
    assert (found.verdict, found.best.effects) == ("named", ("preload",))
    assert [each.chi2 for each in order] == [709.0, 900.0]


def test_a_rival_whose_fit_had_not_ended_is_followed_before_the_gap_to_it_counts(refit):
    base, first = explained(5000.0), explained(705.0, "stribeck")
    second = explained(730.0, "preload", converged=False)
    early = verdict_of(base, first, second)
    assert early.verdict != "tied"
    found, _ = refit(base, early, [first, second], further=explained(706.0, "preload"))
    assert found.verdict == "tied"


def test_noise_as_large_as_the_response_is_not_nothing_missing():
    for power, expected in ((1.9, "data-insufficient"), (2.1, "nothing-missing")):
        base = explained(705.0, power=power)
        assert verdict_of(base, explained(704.0, "stribeck")).verdict == expected
        weak = verdict_of(explained(830.0, power=power), explained(780.0, "stribeck"))
        unconfirmed = on_held_out_tests(weak, explained(830.0, power=power), 0.5, [-0.3, 1.0])
        assert unconfirmed.verdict == expected


def test_an_uncertain_number_at_its_limit_is_the_cause():
    """The base model takes it there and fits, so that nothing is gained on held-out tests."""
    base = explained(745.0, far=("friction_level",))
    best = explained(705.0, "friction_level", uncertain={"friction_level": 0.05}, values=QUARTER)
    found = verdict_of(base, best, explained(740.0, "preload", far=("friction_level",)))
    assert (found.verdict, found.reason, found.best) == ("consistent-with", Reason.AT_LIMIT, best)
    assert found.numbers["standard_deviations"] == pytest.approx(5.0)
    assert on_held_out_tests(found, base, -0.1, [-0.3, 0.1]) is found
    strong = explained(5000.0, far=("friction_level",))
    assert verdict_of(strong, best).verdict == "named"


QUARTER = {"friction_level": {"scale": 0.75}}


@pytest.mark.parametrize(("relaxed", "expected"), [(None, "none-of-mine"), (650.0, "consistent-with")])
def test_a_model_error_that_is_met_is_not_refused_by_a_second_test(relaxed, expected):
    best = explained(705.0, "stribeck", constant=1e-4, relaxed=relaxed)
    assert verdict_of(explained(5000.0, relaxed=relaxed), best).verdict == expected


def rated(accuracy, *effects, held_out=None):
    return Rated(explained(5000.0 * accuracy, *effects), accuracy, None, held_out)


@pytest.mark.parametrize(
    ("base", "best", "rival", "pair", "with_it", "expected"),
    [
        ((0.47, 0.70), (0.004, 0.016), 0.26, 0.008, 0.003, "consistent-with"),
        ((np.inf, None), (0.004, 0.016), 0.26, 0.008, 0.003, "consistent-with"),
        ((0.62, 0.65), (0.056, 0.06), 0.18, 0.06, 0.03, "consistent-with"),
        ((0.47, 0.70), (0.004, 0.016), 0.009, 0.008, 0.003, "none-of-mine"),
        ((0.47, 0.70), (0.004, 0.016), 0.26, 0.003, 0.003, "tied"),
        ((0.47, 0.70), (0.004, 0.016), 0.26, 0.001, 0.003, "none-of-mine"),
        ((0.47, 0.70), (0.004, 0.4), 0.26, 0.008, 0.003, "none-of-mine"),
        ((0.47, 0.70), (0.004, None), 0.26, 0.008, 0.003, "none-of-mine"),
        ((0.47, 0.70), (0.004, 0.016), 0.26, 0.008, 0.001, "consistent-with"),
        ((0.009, 0.70), (0.004, 0.016), 0.26, 0.008, 0.003, "none-of-mine"),
        ((2.0, 2.0), (0.3, 0.3), 1.0, 0.8, 0.003, "none-of-mine"),
        ((0.011, 0.02), (0.0, 0.0), 0.0, 0.0, 0.0, "none-of-mine"),
    ],
)
def test_one_effect_that_is_far_more_accurate_than_all_others_is_the_cause(
    base, best, rival, pair, with_it, expected
):
    """Though none reaches the noise; not if a pair without it is far better, or held-out tests disagree.

    A pair without it that is a little more accurate may be the same physics: the two are tied.
    """
    unexplained = verdict_of(explained(5000.0), explained(1500.0, "ageing"))
    single = rated(best[0], "ageing", held_out=best[1])
    levels = (
        Level((rated(base[0], held_out=base[1]),)),
        Level((single, rated(rival, "stribeck"))),
        Level((rated(with_it, "ageing", "preload"), two := rated(pair, "stribeck", "preload"))),
    )
    found = verdict.by_accuracy(unexplained, levels)
    assert found.verdict == expected
    assert found.rivals == ((two.explanation,) if expected == "tied" else ())
    if expected != "none-of-mine":
        assert (found.reason, found.cause) == (Reason.MORE_ACCURATE, single.explanation)
        assert found.numbers["next_best"] == rival
        # One that holds the cause and leaves much less may have its numbers.
        assert [each["accuracy"] for each in found.numbers["larger"]] == [0.001] * (with_it == 0.001)
    named = verdict_of(explained(5000.0), explained(705.0, "stribeck"))
    assert verdict.by_accuracy(named, levels) is named


@pytest.mark.parametrize(
    ("single", "pair", "rival", "shared", "three", "expected"),
    [
        (0.18, 0.007, 0.038, "guide_friction", 0.005, "consistent-with"),
        (0.012, 0.007, 0.038, "guide_friction", 0.005, "none-of-mine"),
        (0.18, 0.007, 0.038, "guide_friction", 0.003, "consistent-with"),
        (0.18, 0.007, 0.015, "guide_friction", 0.005, "tied"),
        (0.18, 0.007, 0.015, "guide_friction", 0.003, "tied"),
        (0.18, 0.007, 0.015, "stribeck", 0.005, "none-of-mine"),
        (0.033, 0.007, 0.015, "guide_friction", 0.005, "none-of-mine"),
    ],
)
def test_two_effects_that_are_far_more_accurate_than_all_others_are_the_cause(
    single, pair, rival, shared, three, expected
):
    """Two pairs with one effect in common that both lead by far are tied."""
    unexplained = verdict_of(explained(5000.0), explained(1500.0, "presliding"))
    best = rated(pair, "guide_friction", "presliding", held_out=pair)
    levels = (
        Level((rated(0.39, held_out=0.4),)),
        Level((rated(single, "stribeck", held_out=0.2), rated(1.05 * single, "guide_friction"))),
        Level((best, second := rated(rival, shared, "series_compliance"))),
        Level((rated(three, "guide_friction", "presliding", "channel_delay"),)),
    )
    found = verdict.by_accuracy(unexplained, levels)
    assert found.verdict == expected
    assert (found.cause is best.explanation) == (expected != "none-of-mine")
    assert found.rivals == ((second.explanation,) if expected == "tied" else ())
    # One that holds them as a special case is no other explanation, but must lead clearly as well.
    springs = Level((rated(0.9 * pair, "maxwell_presliding", "presliding", "channel_delay"),))
    assert verdict.by_accuracy(unexplained, (*levels[:3], springs)).verdict == expected
    # Three more that are a little more accurate tie with one, and are too many beside two.
    third = ("preload", "cross_slip", "viscous_damping")
    crowd = Level(tuple(rated(0.9 * pair, "stribeck", "ageing", each) for each in third))
    crowded = {"consistent-with": "tied", "tied": "none-of-mine"}.get(expected, expected)
    assert verdict.by_accuracy(unexplained, (*levels[:3], crowd)).verdict == crowded
    two_numbers = Level((rated(pair, "bolster_mass", "bolster_stiffness", held_out=pair),))
    assert verdict.by_accuracy(unexplained, (*levels[:2], two_numbers)).verdict == "none-of-mine"


@pytest.mark.parametrize(
    ("found", "searched", "confirmed", "expected"),
    [
        ("named", True, True, "named"),
        ("named", False, True, "consistent-with"),
        ("named", True, False, "consistent-with"),
        ("none-of-mine", True, False, "none-of-mine"),
        ("none-of-mine", False, False, "data-insufficient"),
        ("tied", False, False, "tied"),
        ("nothing-missing", False, False, "nothing-missing"),
    ],
)
def test_a_verdict_claims_no_more_than_was_done(found, searched, confirmed, expected):
    others = {
        "named": [explained(705.0, "stribeck")],
        "none-of-mine": [explained(1500.0, "stribeck")],
        "tied": [explained(705.0, "stribeck"), explained(709.0, "preload")],
    }
    base = explained(5000.0 if found in others else 700.0)
    before = verdict_of(base, *others.get(found, ()))
    assert before.verdict == found
    after = verdict.as_far_as_done(before, True, searched, confirmed)
    assert (after.verdict, after.best) == (expected, before.best)
    assert (after.reason is Reason.UNCHECKED) == (expected != found)


def test_nothing_is_missing_only_once_all_effects_were_tried():
    before = verdict_of(explained(700.0))
    after = verdict.as_far_as_done(before, False, False, False)
    assert (before.verdict, after.verdict) == ("nothing-missing", "data-insufficient")
    assert after.reason is Reason.UNSEARCHED


@pytest.mark.parametrize(("elastic", "kept"), [(0.04, False), (0.01, True)])
def test_elastic_friction_is_rated_where_it_clearly_surpasses_rigid_friction(elastic, kept):
    """It comes as close to rigid friction as it likes, alone and beside others."""
    for others in ((), ("directional_damping",)):
        rigid = rated(0.05, "guide_friction", *others)
        other = rated(elastic, "maxwell_presliding", *others)
        found = ladder._surpassing_limits([rigid, other])
        assert found == ([rigid, other] if kept else [rigid])
        # It stays where something of another kind is worse than it, and better than its limit.
        between = rated(0.045, "degressive_damping", *others)
        assert other in ladder._surpassing_limits([rigid, other, between])
