"""Joints that lift off or jam, hidden in tests and found; and told where tests cannot show them."""

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL, drawn, searched
from wedgesweep import config
from wedgesweep.diagnose import score_test, verdict
from wedgesweep.diagnose.diagnosis import refit_cause
from wedgesweep.diagnose.result.estimates import parameters
from wedgesweep.diagnose.search import Search, base_fit
from wedgesweep.diagnose.stages import explain
from wedgesweep.effects import go_together

NAME = "lift_off"
# Frequencies (Hz) and amplitudes (m) of tests, in four of which wedges lift off, and of quieter ones.
LOUD = np.array([8.0, 11.0, 11.0, 14.0, 20.0, 28.0]), 1e-3 * np.array([1.6, 0.4, 0.16, 0.8, 0.2, 0.6])
QUIET = np.array([8.0, 11.0, 20.0, 24.0]), 1e-3 * np.array([0.8, 0.16, 0.15, 0.1])
# What imitates it best, and one that does not go with it.
CANDIDATES = (NAME, "viscous_damping", "input_distortion", "column_compliance")


def measured(law, effects, bench=LOUD):
    return drawn(effects, bench=bench, law=law, model=MODEL.replace("static-dynamic", law), std=0.005)


def decided(data):
    search, base, found, scans = explain(Search.of(data, CANDIDATES))
    thresholds = verdict.thresholds_for(data)
    finding = verdict.decide(base, found, thresholds)
    finding, _ = refit_cause(search, base, finding, found, thresholds)
    return finding, score_test.scores(search, base, scans)


@pytest.mark.acceptance
def test_it_is_named_with_its_restitution():
    law, restitution = "coulomb", 0.4
    finding, _ = decided(measured(law, {NAME: {"restitution": restitution}}))
    assert finding.verdict == verdict.NAMED
    assert finding.best.effects == (NAME,)
    low, high = parameters(finding.best)[NAME]["restitution"]["ci95"]
    assert low <= restitution <= high
    assert high - low < 0.5


@pytest.mark.acceptance
def test_its_fit_finds_uncertain_numbers_of_its_own():
    """Fitted without it, friction and stiffness end at other values than those which it needs."""
    restitution = 0.2
    bench = (
        np.array([4.819, 4.819, 7.649, 7.649, 10.691, 19.749, 19.749, 23.005]),
        1e-3 * np.array([6.451, 30.48, 2.315, 8.188, 1.955, 0.3441, 0.9419, 0.313]),
    )
    own = {"friction_level": 1.06, "wedge_stiffness": 1.02, "bolster_mass": 0.99}
    data = drawn(
        {NAME: {"restitution": restitution}} | {name: {"scale": scale} for name, scale in own.items()},
        bench=bench,
        law="exponential",
        model=MODEL.replace("static-dynamic", "exponential") + "[suspension]\ncolumn_angle_deg = 4.0\n",
        std=0.001,
        uncertain={"friction_level": 0.06, "wedge_stiffness": 0.02, "bolster_mass": 0.01},
    )
    _, _, (found,) = searched(data, NAME)
    assert found.chi2 < 1.2 * data.dof.sum()
    assert found.values[NAME]["restitution"] == pytest.approx(restitution, abs=0.05)


@pytest.mark.acceptance
def test_a_bench_whose_joints_hold_misses_nothing_though_they_pull():
    data = measured("static-dynamic", {})
    finding, scores = decided(data)
    assert finding.verdict == verdict.NOTHING
    score = next(each for each in scores if each.effect == NAME)
    assert score.testable
    assert score.detectable == 0.0


@pytest.mark.acceptance
def test_tests_in_which_nothing_lifts_off_cannot_show_it():
    data = measured("coulomb", {NAME: {"restitution": 0.3}}, QUIET)
    search, base, *_ = base_fit(Search.of(data, (NAME,)))
    (score,) = score_test.scores(search, base, {})
    assert not score.testable
    assert verdict.decide(base, [], verdict.DEFAULT).verdict == verdict.NOTHING


def test_it_is_no_candidate_beside_what_it_does_not_go_with():
    model = config.parse(MODEL)
    assert NAME in model.possible_effects
    for more in (
        "[effects.presliding]\nlength_mm = 0.1\n",
        "[suspension]\ncolumn_angle_deg = 0.0\n",
        '[suspension]\njoints = "unilateral"\n',
    ):
        assert NAME not in config.parse(MODEL + more).possible_effects
    opens = config.parse(MODEL + "[effects.lift_off]\n")
    assert "cross_slip" not in opens.possible_effects
    assert {"stribeck", "preload", "guide_friction"} < set(opens.possible_effects)
    assert not go_together((NAME, "cross_slip"))
    assert go_together((NAME, "stribeck"))


def test_an_effect_is_the_same_as_the_joints_of_the_config():
    as_effect, as_joints = (
        config.parse(MODEL + more)
        for more in (
            "[effects.lift_off]\nrestitution = 0.3\n",
            '[suspension]\njoints = "unilateral"\nrestitution = 0.3\n',
        )
    )
    (case,) = as_effect.case_list()
    assert as_effect.record(case) == as_joints.record(case)
    with pytest.raises(config.ConfigError, match=r"effects\.lift_off: .* says the same"):
        config.parse(MODEL + '[suspension]\njoints = "unilateral"\n[effects.lift_off]\n')


# Frequencies (Hz), and amplitudes (m) of base accelerations of 0.9 to 2.4 m/s2: all break away.
FREQUENCIES = np.array([8.0, 12.0, 16.0, 20.0, 24.0, 30.0])
AMPLITUDES = np.array([0.9, 1.1, 1.3, 1.6, 2.0, 2.4]) / (2.0 * np.pi * FREQUENCIES) ** 2


@pytest.mark.acceptance
@pytest.mark.parametrize("locked_in", [0.5])
def test_it_is_named_with_its_share(locked_in):
    hidden = {"jamming": {"locked_in": locked_in}}
    model = MODEL.replace("static-dynamic", "coulomb")
    data = drawn(hidden, bench=(FREQUENCIES, AMPLITUDES), law="coulomb", model=model, std=0.005)
    candidates = ("jamming", "friction_level", "guide_friction", "stribeck")
    _, base, explanations, _ = explain(Search.of(data, candidates))
    finding = verdict.decide(base, explanations, verdict.thresholds_for(data))
    assert finding.verdict == verdict.NAMED
    assert finding.best.effects == ("jamming",)
    low, high = parameters(finding.best)["jamming"]["locked_in"]["ci95"]
    assert low <= locked_in <= high
