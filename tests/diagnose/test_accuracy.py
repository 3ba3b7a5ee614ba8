"""The accuracy of a model is the relative model error that was planted, whatever its shape and unit."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.diagnose.synthetic import LAG, base_of, drawn, searched
from wedgesweep.diagnose import accuracy, ladder
from wedgesweep.diagnose.cross_validation import Predictor
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.model import Model

EXACT = {"level": 1e-4, "std": 1e-6}
SIZES = 0.003, 0.01, 0.04, 0.3


def planted(size, shape, seed=0, **options):
    """Data of the base model with an error of a relative size, over the harmonics as ``shape`` (H,)."""
    rng = np.random.default_rng(seed)
    data = drawn(seed=seed, **{**EXACT, **options})
    spectra = []
    for spectrum in data.spectra:
        error = shape * (rng.normal(size=(2, *spectrum.mean.shape)).T @ [1.0, 1.0j]).T
        rms = np.linalg.norm(spectrum.mean, axis=1) / np.linalg.norm(error, axis=1)
        spectra.append(replace(spectrum, mean=spectrum.mean + size * rms[:, None] * error))
    return replace(data, spectra=tuple(spectra))


def as_it_is(data):
    """The base model where it was made, not fitted."""
    model = Model(data, Hypothesis(), tolerance=1e-8)
    return model.evaluate(model.start(None, np.zeros(0)))


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize(
    ("shape", "seen"),
    [(np.ones(16), 1.0), (np.arange(16) < 1, 0.75), (np.arange(16) > 11, 1.0)],
    ids=["all", "fundamental", "high"],
)
def test_what_was_planted_is_found(size, shape, seen):
    """Relative to what was measured, the error included.

    The limit of chi-squared at p = 0.01 is a sixth above its mean with 378 degrees of freedom. The start
    phase takes up one of the four numbers that the fundamentals of two channels are.
    """
    data = planted(size, shape)
    found = accuracy.of_responses([(data, as_it_is(data))], 378)
    assert found == pytest.approx(size / np.hypot(1.0, size) * np.sqrt(seen * 378.0 / 446.0), rel=0.04)


def test_no_model_error_is_noise_alone():
    """Bit for bit, with coherent channels too."""
    data = drawn(LAG)
    data = replace(data, spectra=tuple(replace(each, coherence=0.3 + 0.4j) for each in data.spectra))
    zero = data.with_model_error(0.0)
    here = as_it_is(data)
    assert np.array_equal(data.weight, zero.weight)
    assert np.array_equal(here.residual, as_it_is(zero).residual)
    assert here.chi2 == pytest.approx(zero.compared_again(here).chi2, rel=1e-12)
    assert not data.model_misfit.any()
    small = data.with_model_error(1e-7).compared_again(here)
    assert small.chi2 == pytest.approx(here.chi2, rel=1e-4)


def test_chi_squared_falls_as_the_model_error_grows():
    data = drawn(LAG)
    data = replace(data, spectra=tuple(replace(each, coherence=0.3 + 0.4j) for each in data.spectra))
    here = as_it_is(data)
    sizes = [0.0, *np.geomspace(1e-5, 10.0, 50)]
    chi2 = [data.with_model_error(size).compared_again(here).chi2 for size in sizes]
    assert (np.diff(chi2) < 0.0).all()
    misfit = [data.with_model_error(size).model_misfit.sum() for size in sizes]
    assert (np.diff(misfit) > 0.0).all()
    assert misfit[-1] == pytest.approx(data.observations.sum(), rel=1e-3)


def test_noise_of_the_same_size_as_the_model_error_doubles_the_variance():
    data = drawn(level=0.05)
    doubled = data.with_model_error(data.noise_floor)
    assert doubled.model_misfit.sum() == pytest.approx(0.5 * data.observations.sum(), rel=0.05)
    # A sample's noise over its rms, less what the fit of 32 numbers to 1600 samples averages out.
    assert data.noise_floor == pytest.approx(0.05 * np.sqrt(32.0 / 1600.0), rel=0.05)


def test_what_is_adequate_with_noise_alone_needs_no_model_error():
    fit = base_of(drawn())
    assert accuracy.of_fit(fit) == 0.0
    assert accuracy.refined(fit) == (0.0, fit)


def test_a_fit_is_repeated_where_the_model_error_has_its_weight():
    """One test that is far off and has little noise drags a fit at noise weights away from all others."""
    data = drawn(LAG, std=0.1, level=0.005)
    fit = base_of(data)
    before, after = accuracy.of_fit(fit), accuracy.refined(fit)
    assert 0.0 < after.size <= before
    again = minimise(after.fit.model, after.fit.evaluation)
    assert again.chi2 == pytest.approx(after.fit.chi2, rel=0.02)


def test_the_true_effect_leads_the_ladder():
    search, base, singles = searched(drawn(LAG), "displacement_gain", "velocity_lag")
    none, one = ladder.ladder(search, base, singles, Predictor(search.each))
    assert (none.best.effects, one.best.effects) == ((), ("velocity_lag",))
    assert (one.best.accuracy, one.distinct) == (0.0, np.inf)
    assert one.rivals[0].accuracy <= none.best.accuracy * 1.001
    # It also predicts tests that it was not fitted to, to less than the noise of what is compared.
    assert one.best.held_out < search.data.noise_floor < none.best.held_out


@pytest.mark.acceptance
def test_a_cause_leads_though_the_model_is_nowhere_right_to_within_the_noise():
    data = drawn({**LAG, "displacement_gain": {"scale": 1.004}}, std=1e-4, level=0.005)
    search, base, singles = searched(data, "guide_friction", "velocity_lag", "bolster_mass")
    none, one = ladder.ladder(search, base, singles, Predictor(search.each))
    assert one.best.effects == ("velocity_lag",)
    assert 0.001 < one.best.accuracy < 0.006
    assert none.best.accuracy > 5.0 * one.best.accuracy
    assert one.distinct > 3.0
    assert one.best.held_out == pytest.approx(one.best.accuracy, rel=0.5)
    assert none.best.held_out > 5.0 * one.best.held_out


@pytest.mark.acceptance
def test_explanations_on_copies_of_the_data_are_rated(monkeypatch):
    """As after a fit that knows more of the records' start; the second best waits for its turn."""
    monkeypatch.setattr(ladder, "REFINED", 1)
    search, base, singles = searched(drawn(LAG), "displacement_gain", "velocity_lag")
    copied = [replace(fit.model.data, amplitude=fit.model.data.amplitude.copy()) for fit in singles]
    copies = [replace(fit, model=fit.model.on(data)) for fit, data in zip(singles, copied, strict=True)]
    _, one = ladder.ladder(search, base, copies, Predictor(search.each))
    assert [each.effects for each in one.rated] == [("velocity_lag",), ("displacement_gain",)]


def test_what_has_the_smallest_misfit_is_rated_at_its_accuracy(monkeypatch):
    """One friction in records of many: far from its accuracy as fitted, behind many that explain nothing."""

    def rated(accuracy, penalised):
        return ladder.Rated(SimpleNamespace(penalised=penalised, effects=()), accuracy, None)

    others = [rated(0.69, 9e5 + i) for i in range(12)]
    rough = sorted([*others, right := rated(1.2, 2e5)], key=ladder.by_accuracy)
    improved = {id(right): replace(right, accuracy=0.5)}
    monkeypatch.setattr(ladder, "_refined", lambda each: improved.get(id(each), each))
    monkeypatch.setattr(ladder, "held_out_accuracy", lambda fit, predict: 0.5)
    level = ladder.level_of(SimpleNamespace(each=map), rough, None)
    assert (level.best.explanation, level.best.accuracy) == (right.explanation, 0.5)
    assert len(level.rated) == 13
