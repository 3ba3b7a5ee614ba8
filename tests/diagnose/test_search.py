"""Where the search for an explanation continues and ends, and pairs that do not show alone."""

from dataclasses import replace
from types import MappingProxyType, SimpleNamespace

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL, base_of, drawn, next_to_breakaway, searched
from wedgesweep.diagnose import pairs, stages
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.search import (
    Explained,
    Search,
    base_fit,
    beside_stated,
    best_of,
    best_per_value,
    refit_base,
    single_fit,
    single_fits,
)


def test_a_rough_misfit_is_not_taken_for_that_of_a_fit():
    search = Search.of(drawn({"velocity_lag": {"time": 3e-4}}), ())
    model = search.model("displacement_gain")
    evaluation = model.evaluate(model.start(None, np.array([1.02])))
    flattered = replace(evaluation, residual=0.1 * evaluation.residual)
    fit = best_of(model, [flattered])
    assert fit.chi2 == pytest.approx(model.evaluate(fit.evaluation.point).chi2, rel=1e-3)


@pytest.mark.acceptance
@pytest.mark.parametrize("length", [0.9e-6, 1.5e-6])
def test_an_effect_with_which_the_base_model_fits_implausibly_starts_without_it(length):
    """Faces that creep where the base model's stick: it moves only with far less friction or input.

    Nor does a fit get there whose inputs are free to make up for a length that is wrong by then.
    """
    bench = np.array([20.0, 30.0, 6.0]), 1e-3 * np.array([0.0663, 0.0471, 0.2133])
    data = drawn(
        {"presliding": {"length": length}}, bench=bench, std=0.01, uncertain={"friction_level": 0.02}
    )
    _, base, (found,) = searched(data, "presliding")
    assert np.abs(base.evaluation.point.nuisance[:, 0]).max() > 1.0
    assert found.p > 1e-3
    assert found.values["presliding"]["length_mm"] == pytest.approx(1e3 * length, rel=0.05)


@pytest.mark.acceptance
def test_an_effect_is_fitted_beside_what_is_stated_where_the_base_model_needs_other_numbers():
    """Springs, mass and friction go as far as they may to make up for friction that falls with velocity."""
    stds = {"bolster_stiffness": 0.01, "wedge_stiffness": 0.01, "bolster_mass": 0.005, "friction_level": 0.03}
    hidden = {"stribeck": {"peak": 0.0578, "velocity": 36.4e-3}}
    search, base, *_ = base_fit(Search.of(clean(effects=hidden, uncertain=stds), ("stribeck",)))
    assert base.implausible
    model = search.model("stribeck")
    started = model.evaluate_all([model.start(None, x) for x in model.hypothesis.starts()[::5]])
    ended = beside_stated(model, started)
    for each in ended:
        np.testing.assert_array_equal(each.point.x[model.size :], model.uncertain.mean)
    assert min(each.chi2 for each in ended) < 0.5 * min(each.chi2 for each in started)
    assert single_fit(search, "stribeck", base).fit.p > 1e-3


def test_an_undetected_tone_leaves_nothing_to_fit():
    search = Search.of(drawn({"viscous_damping": {"coefficient": 8.0}}), ("stray_vibration",))
    _, base, found, _ = stages.explain(search)
    assert base.p < 1e-9
    assert found == []


# A set on which the base model stopped short: friction 3 % off, inputs by up to three standard deviations.
FREQUENCIES = np.array([5.18, 5.18, 8.0, 8.0, 11.31, 19.23, 19.23, 22.86, 22.86, 27.83, 33.24, 33.24])
STATED = np.array([1.103, 2.929, 0.528, 1.176, 0.355, 0.0796, 0.1828, 0.0675, 0.1789, 0.0645, 0.0278, 0.0686])
OFF = np.array([-2.8, 1.5, 0.0, 1.0, -1.3, 0.2, -2.0, -0.5, 2.3, -0.7, -0.8, 2.7]) / 100.0


def clean(seed=0, effects=MappingProxyType({}), uncertain=MappingProxyType({"friction_level": 0.058})):
    return drawn(
        {"friction_level": {"scale": 0.971}, **effects},
        seed=seed,
        std=0.013,
        uncertain=dict(uncertain),
        off=OFF,
        bench=(FREQUENCIES, 1e-3 * STATED),
        model=MODEL + "[suspension]\ncolumn_angle_deg = -4.0\n",
    )


def test_starts_differ_in_the_wavelength_of_a_wave_not_in_the_sign_of_its_amplitude():
    starts = Hypothesis(("position_friction",)).starts()
    rated = [SimpleNamespace(point=SimpleNamespace(x=x), chi2=float(i)) for i, x in enumerate(starts)]
    wavelengths = [each.point.x[2] for each in best_per_value(rated)]
    assert sorted(wavelengths) == sorted(set(starts[:, 2].tolist()))


@pytest.mark.few(1)
@pytest.mark.parametrize("seed", range(2))
def test_the_base_model_does_not_stop_short_of_its_uncertain_numbers(seed):
    base = base_of(clean(seed))
    assert base.x == pytest.approx([0.971], abs=0.003)
    assert base.p > 1e-3


# A set on which inputs made up for friction that was two standard deviations off: 40 % of each was taken off.
FASTER = np.array(
    [4.929, 4.929, 8.279, 8.279, 11.519, 20.368, 20.368, 23.681, 23.681, 27.455, 30.671, 30.671]
)
LARGER = [4.223, 4.434, 1.570, 1.622, 0.8115, 0.2413, 0.2499, 0.1772, 0.1797, 0.1455, 0.1093, 0.1151]
ASIDE = np.array([-1.2, 1.4, 0.0, -2.6, 1.1, 0.7, 2.5, 2.5, 1.2, 0.2, 0.9, -0.7]) / 100.0


@pytest.mark.few(1)
@pytest.mark.parametrize("seed", range(2))
def test_inputs_do_not_make_up_for_uncertain_numbers(seed):
    data = drawn(
        {"friction_level": {"scale": 1.155}},
        seed=seed,
        std=0.0152,
        uncertain={"friction_level": 0.072},
        off=ASIDE,
        bench=(FASTER, 1e-3 * np.array(LARGER)),
        law="coulomb",
        model=MODEL + "[suspension]\ncolumn_angle_deg = -4.0\n",
    )
    base = base_of(data)
    assert base.x == pytest.approx([1.155], abs=0.003)
    assert base.p > 1e-3


def test_the_base_model_goes_on_from_where_an_extension_got(monkeypatch):
    search = Search.of(clean(), ("velocity_lag",))
    with monkeypatch.context() as alone:
        alone.setattr(
            "wedgesweep.diagnose.search._halved",
            lambda model, evaluations, *_, **__: minimise(model, evaluations[0], iterations=1),
        )
        alone.setattr("wedgesweep.diagnose.search._nuisances_held", lambda model, evaluation: evaluation)
        short = base_fit(search).base
    assert short.p < 1e-9
    model = search.model("velocity_lag")
    there = model.evaluate(model.start(base_fit(search).base, model.hypothesis.low))
    again = refit_base(Explained(search, short, [minimise(model, there)], {})).base
    assert again.p > 1e-3
    assert refit_base(Explained(search, again, [short], {})).base is again


# More preload and less friction: alone, neither explains as much as another mass.
TRUTH = {"preload": {"force": 0.3}, "friction_level": {"scale": 0.85}}
CANDIDATES = (*TRUTH, "bolster_mass")


def test_pairs_are_found_whose_effects_do_not_lead_alone():
    search, base, singles, scans = single_fits(base_fit(Search.of(drawn(TRUTH), CANDIDATES)))
    assert min(singles, key=lambda each: each.chi2).effects == ("bolster_mass",)
    best = pairs.fit_pairs(search, base, singles, scans)[0]
    assert set(best.effects) == set(TRUTH)
    assert best.p > 1e-3


@pytest.mark.acceptance
def test_where_responses_do_not_add_the_second_effect_begins_with_nothing():
    """By every start of the damper that was tried a test sticks."""
    search, base, *_ = base_fit(Search.of(next_to_breakaway(), ("stribeck", "viscous_damping")))
    damper, stribecks = (single_fit(search, effect, base) for effect in ("viscous_damping", "stribeck"))
    model = search.model("stribeck")
    stribeck = minimise(model, model.evaluate(model.start(base, np.array([6e-3, -0.43]))), 3)
    first = pairs.single_scan(base, stribeck, stribecks.scan)
    second = pairs.single_scan(base, damper.fit, damper.scan)
    begun = pairs.starting_fit(search, pairs.Combination(first, second))
    assert begun.chi2 < pairs.BEHIND * first.subset.chi2


def fits(*misfits, p):
    """Stand-ins of fits to several pairs; ``p``: probability of the best one's misfit."""
    return [
        SimpleNamespace(chi2=q, dof=50, p=p if q == min(misfits) else 0.0, effects=(str(i), "other"))
        for i, q in enumerate(misfits)
    ]


def test_only_what_is_far_behind_a_pair_that_will_do_is_given_up():
    far = 2.0 * pairs.BEHIND * 100.0
    near = 0.9 * pairs.BEHIND * 100.0
    several = fits(far, 100.0, *[near] * pairs.SEVERAL, far, p=0.5)
    assert [fit.chi2 for fit in pairs.promising(several)] == [100.0, *[near] * pairs.SEVERAL]
    assert len(pairs.promising(fits(100.0, *[far] * 9, p=0.5))) == pairs.SEVERAL
    assert len(pairs.promising(fits(100.0, *[far] * 9, p=1e-6))) == 10
