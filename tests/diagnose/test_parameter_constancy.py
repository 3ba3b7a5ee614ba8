"""Whether a number that is fitted to all tests is the same in all of them."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.synthetic import AMPLITUDES, FREQUENCIES, drawn, searched
from wedgesweep.diagnose import accuracy, ladder, stages, verdict
from wedgesweep.diagnose.cross_validation import Predictor
from wedgesweep.diagnose.parameter_constancy import Projector, _p_constant, parameter_constancy
from wedgesweep.diagnose.search import Search

# Sessions of twelve tests; of one that wears the last ones differ from the first by a little.
BENCH = np.tile(FREQUENCIES, 2), np.r_[AMPLITUDES, 1.3 * AMPLITUDES]
RIGHT = {
    "friction_level": {"scale": 1.1},
    "viscous_damping": {"coefficient": 6.0},
    "cross_slip": {"velocity": 1e-3, "phase": 0.7},
}


def worn(first, last, seed=0, since=4):
    """Tests of two levels of friction in one session, the last ones from ``since`` on."""
    several = [drawn({"friction_level": {"scale": s}}, seed=seed, bench=BENCH) for s in (first, last)]
    spectra = several[0].spectra[:since] + several[1].spectra[since:]
    return replace(several[0], spectra=spectra)


@pytest.mark.acceptance
@pytest.mark.parametrize("effect", RIGHT)
def test_numbers_of_the_right_effect_are_constant_as_often_as_chance_has_it(effect):
    found = []
    for seed in range(12):
        data = drawn({effect: RIGHT[effect]}, seed=seed, bench=BENCH)
        _, _, (single,) = searched(data, effect)
        found.append(single.constancy.p)
    assert min(found) > 1e-3
    assert 0.3 < np.mean(found) < 0.9


def test_a_number_that_changes_in_the_session_is_found_long_before_noise_is_exceeded():
    _, _, (single,) = searched(worn(1.10, 1.114), "friction_level")
    assert single.p > verdict.ADEQUATE
    assert single.constancy.p < 1e-6
    assert single.constancy.parameter == "friction_level.scale"


def test_what_changes_in_the_session_is_not_named():
    data = worn(1.10, 1.114)
    _, base, found, _ = stages.explain(Search.of(data, ("friction_level",)))
    assert base.excess > verdict.STRONG
    assert verdict.decide(base, found, verdict.DEFAULT).verdict == "none-of-mine"


def test_what_changes_in_the_session_limits_the_accuracy():
    """Noise alone would allow any accuracy. A change of 1.3 % makes errors of less than half of that."""
    _, _, (same,) = searched(worn(1.10, 1.10), "friction_level")
    assert accuracy.with_constant_parameters(same) == 0.0
    search, base, found, _ = stages.explain(Search.of(worn(1.10, 1.114), ("friction_level",)))
    levels = ladder.ladder(search, base, found, Predictor(search.each))
    assert 1e-4 < levels[1].best.accuracy < 0.5 * 0.013
    unexplained = verdict.decide(base, found, verdict.DEFAULT)
    finding = verdict.by_accuracy(unexplained, levels)
    assert finding.verdict == "consistent-with"
    assert finding.numbers["parameter"] == "friction_level.scale"
    _, _, (worse,) = searched(worn(1.10, 1.128), "friction_level")
    assert accuracy.with_constant_parameters(worse) > 2.0 * levels[1].best.accuracy


def test_the_base_model_and_a_single_test_have_nothing_that_could_differ():
    _, base, (single,) = searched(drawn(tests=[0]), "friction_level")
    assert parameter_constancy(base) == (1.0, None)
    assert parameter_constancy(single).p == pytest.approx(1.0)


def test_what_a_fit_leaves_is_out_of_the_reach_of_all_that_was_fitted():
    """At the minimum the misfit with the pulls on the priors contains nothing that could be taken up."""
    off = 0.03 * np.array([1.0, -1.0, 1.0, 1.0, -1.0, 1.0])
    data = drawn({"friction_level": {"scale": 1.1}}, uncertain={"wedge_stiffness": 0.05}, off=off)
    _, _, (single,) = searched(data, "friction_level")
    pulls = (single.evaluation.nuisance_prior**2).sum()
    assert pulls > 5.0
    assert (Projector(single).misfit ** 2).sum() == pytest.approx(single.chi2, abs=0.02 * pulls)


def test_of_two_numbers_either_may_seem_not_to_be_constant_by_chance():
    _, _, (single,) = searched(drawn({"cross_slip": RIGHT["cross_slip"]}, seed=4), "cross_slip")
    project = Projector(single)
    alone = [_p_constant(project, tangent) for tangent in np.moveaxis(project.by_parameter, -1, 0)]
    assert min(alone) < 0.5
    assert single.constancy.p == pytest.approx(2.0 * min(alone))
