"""Predictions of tests that a model was not fitted to: their accuracy, and the gain of an extended model."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr, stdtrit

from wedgesweep.diagnose import accuracy
from wedgesweep.diagnose.evaluation import Evaluation, Point
from wedgesweep.diagnose.explanation import parameter_penalty
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.least_squares import BRIEF, minimise, subset_fit
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.diagnose.normal_equations import normal_equations
from wedgesweep.diagnose.smoothing import TWO_SIDED

# Gauss-Newton steps of what is fitted to a single test, and the largest one of a nuisance parameter.
GAUSS_NEWTON, LOCAL_STEP = 4, 0.3
# Bootstrap samples, and the least number of tests for which an interval means anything.
RESAMPLED, FEWEST = 2000, 8
# Bootstrap samples with less than this share of the excess do not count: there is nothing to be removed.
SHOWS = 0.1
# A parameter is undetermined if its standard deviation exceeds VAGUE times its scale.
VAGUE = 3.0

# Maps a function over a list, perhaps in threads.
Each = Callable[[Callable, list], list]


class Prediction(NamedTuple):
    """Tests that were left out together, simulated by a model that was fitted to the others.

    ``scheme``: what they have in common ("frequency", "record"); ``tests``: their indices in all data;
    ``data``: these tests alone; ``effects``: those that the other tests support; ``x``: numbers of the fit.
    """

    scheme: str
    tests: np.ndarray
    data: FitData
    evaluation: Evaluation
    effects: tuple[str, ...]
    x: np.ndarray

    @property
    def misfit(self) -> np.ndarray:
        """Squared misfit of each test; that of no motion at all where the model has no response."""
        misfit = (self.evaluation.residual**2).sum(-1)
        return np.where(self.evaluation.found_tests, misfit, self.data.power)


@dataclass(frozen=True, eq=False)
class Gain:
    """Squared misfits of n tests that were left out, under models that were fitted to other tests.

    ``schemes`` (n,): by which each was left out; ``tests`` (n,): its index in all data; ``observations``
    (n,): its numbers; ``squares`` (n, 3): what base model, extended model and noise leave. Noise leaves
    less than one for each observation, by what a test tells of its own nuisance parameters.
    """

    schemes: tuple[str, ...]
    tests: np.ndarray
    observations: np.ndarray
    squares: np.ndarray

    @property
    def rmse(self) -> np.ndarray:
        """Root mean squares of the whitened residuals of each test, (n, 3)."""
        return np.sqrt(self.squares / self.observations[:, None])

    def mean_squares(self) -> np.ndarray:
        """Mean squares of the whitened residuals over all tests, (3,)."""
        return self.squares.sum(axis=0) / self.observations.sum()

    @property
    def excess_removed(self) -> float:
        """Share of the base model's excess over noise that the extended model removes, at most 1.

        Noise counts with the model error that is allowed. Less error than that leaves no excess.
        """
        base, extended, noise = self.mean_squares()
        return min(float((base - extended) / (base - noise)), 1.0) if base > noise else 0.0

    @property
    def interval(self) -> list[float] | None:
        """95 % bootstrap interval of ``excess_removed``; None for fewer than FEWEST tests.

        Tests are resampled with all their schemes. Where few tests show the effect, many samples contain none
        of these tests: their excess is noise, and the share that is removed means nothing. Such samples do
        not count. The quantiles are widened, as resampling underestimates the scatter of few tests
        (Hesterberg, 2015, "What teachers should know about the bootstrap", sec. 5.3).
        """
        tests, rows = np.unique(self.tests, return_inverse=True)
        if len(tests) < FEWEST:
            return None
        sums = np.zeros((len(tests), 3))
        np.add.at(sums, rows, self.squares)
        drawn = np.random.default_rng(0).integers(0, len(tests), (RESAMPLED, len(tests)))
        base, extended, noise = sums[drawn].sum(axis=1).T
        excess = base - noise
        shows = excess > max(SHOWS * (sums[:, 0] - sums[:, 2]).sum(), 0.0)
        removed = (base - extended)[shows] / excess[shows] if shows.any() else np.zeros(1)
        tail = ndtr(np.sqrt(len(tests) / (len(tests) - 1.0)) * stdtrit(len(tests) - 1, 0.025))
        low, high = np.quantile(np.minimum(removed, 1.0), [tail, 1.0 - tail])
        return [float(low), float(high)]


class Predictor:
    """Predicts tests that are left out of fits; a fit that is asked for again is not predicted again."""

    def __init__(self, each: Each) -> None:
        """``each`` maps a function over a list, perhaps in threads."""
        self._each, self._known = each, list[tuple[Fit, list[Prediction]]]()

    def __call__(self, fit: Fit) -> list[Prediction]:
        """Predictions of all groups of tests that can be left out of a fit."""
        for known, predicted in self._known:
            if known is fit:
                return predicted
        groups = held_out_groups(fit.model.data)
        predicted = self._each(lambda group: _predicted(fit, *group), groups)
        self._known.append((fit, predicted))
        return predicted


def cross_validate(base: Fit, extended: Fit, predict: Predictor) -> Gain:
    """Leave out groups of tests, fit the others, and predict those that were left out.

    Parameters
    ----------
    base, extended : Fit
        The two models to compare, fitted to all tests.
    predict : Predictor
        Leaves groups of tests out of a fit.
    """
    before, after = predict(base), predict(extended)
    # Without its effects the extended model is the base model, however its nuisance parameters are found.
    after = [own if own.effects else other for own, other in zip(after, before, strict=True)]
    tests = np.concatenate([each.tests for each in before])
    left = [np.concatenate([each.misfit for each in predicted]) for predicted in (before, after)]
    observations = base.model.data.observations
    noise = observations - local_numbers(extended)
    schemes = tuple(each.scheme for each in before for _ in each.tests)
    return Gain(schemes, tests, observations[tests], np.column_stack([*left, noise[tests]]))


def widened(fit: Fit, predict: Predictor) -> Fit:
    """A fit whose intervals are as wide as its numbers scatter between fits without some tests (jackknife).

    What a model lacks is no independent error of each number. Where tests differ, so do the numbers by which
    the model makes up for it (Efron and Tibshirani, 1993, An Introduction to the Bootstrap, ch. 11).
    """
    variance = own = np.diag(fit.covariance)
    predicted = [each for each in predict(fit) if each.effects == fit.effects]
    for scheme in {each.scheme for each in predicted}:
        x = np.array([each.x for each in predicted if each.scheme == scheme])
        if len(x) > 1:
            of_few = float(stdtrit(len(x) - 1, 0.975)) / TWO_SIDED
            variance = np.maximum(variance, own + of_few**2 * (len(x) - 1) * x.var(axis=0))
    factor = np.sqrt(variance / np.where(own > 0.0, own, 1.0))
    return replace(fit, covariance=fit.covariance * np.outer(factor, factor))


def held_out_accuracy(fit: Fit, predict: Predictor) -> float | None:
    """Accuracy of the predictions of tests that were left out of a fit; None if there are none."""
    predicted = predict(fit)
    return accuracy_of(predicted, fit) if predicted else None


def accuracy_of(predicted: Sequence[Prediction], fit: Fit) -> float:
    """Accuracy of predictions of tests that were left out of a fit."""
    left = fit.model.data.observations - local_numbers(fit)
    dof = sum(left[one.tests].sum() for one in predicted)
    return accuracy.of_responses([(one.data, one.evaluation) for one in predicted], dof)


def held_out_groups(data: FitData) -> list[tuple[str, np.ndarray]]:
    """Schemes and groups that leave tests to fit; if all tests are alike, each test by itself."""
    groups = [group for group in data.held_out_groups() if len(group[1]) < data.tests]
    if groups or data.tests == 1:
        return groups
    return [("test", np.array([test])) for test in range(data.tests)]


def local_numbers(fit: Fit) -> np.ndarray:
    """Number (T,) of nuisance parameters that each test determines; one with a prior counts in part."""
    model = fit.model
    equations = normal_equations(model.holding(slice(None), fit.x), fit.evaluation)
    first, last = equations.eliminated, equations.eliminated + model.nuisance_weight.shape[1]
    block = equations.local_block[:, :last, :last]
    coupling = block[:, :first, first:]
    reduced = block[:, first:, first:] - np.swapaxes(coupling, 1, 2) @ np.linalg.solve(
        block[:, :first, :first], coupling
    )
    known = model.nuisance_weight**2 * np.diagonal(np.linalg.inv(reduced), axis1=1, axis2=2)
    determined = np.clip(1.0 - known, 0.0, 1.0).sum(axis=1)
    # Of several kinds of test not all have as many.
    eliminated = model.data.eliminated_derivatives(fit.evaluation).any(axis=1).sum(axis=1)
    return eliminated + determined + model.data.extra_nuisances(fit.effects)


def _predicted(fit: Fit, scheme: str, rows: np.ndarray) -> Prediction:
    """Simulation of the tests ``rows`` after a fit to the other tests.

    Nuisance parameters of held-out tests are fitted as far as their kind of record allows
    (``FitData.predicted_nuisances``).
    """
    trained = subset_fit(fit, np.setdiff1d(np.arange(fit.model.data.tests), rows))
    if len(fit.x):
        trained = supported(minimise(trained.model, trained.evaluation, BRIEF))
    part = subset_fit(fit, rows)
    part = replace(part, model=replace(part.model, hypothesis=trained.model.hypothesis))
    evaluation = with_own_nuisances(part.model, replace(part.point, x=trained.x))
    return Prediction(scheme, rows, part.model.data, evaluation, trained.effects, trained.x)


def supported(trained: Fit) -> Fit:
    """The fit, without effects that the remaining tests do not support.

    A parameter that they leave undetermined stays where the fit to all tests had left it, so that it knows of
    the tests that were left out. If its effect gains less than its parameters cost, it is removed.
    """
    for effect in undetermined(trained):
        rest = tuple(name for name in trained.effects if name != effect)
        model = replace(trained.model, hypothesis=replace(trained.model.hypothesis, effects=rest), held=None)
        x = model.hypothesis.at(trained.values)
        less = minimise(model, model.evaluate(model.start(trained, x)), BRIEF)
        saved = parameter_penalty(model.data) * (trained.model.size - model.size)
        if less.chi2 < trained.chi2 + saved:
            trained = less
    return trained


def undetermined(fit: Fit) -> tuple[str, ...]:
    """Effects with a parameter whose standard deviation exceeds VAGUE of its scales."""
    std = np.sqrt(np.diag(fit.covariance))[: fit.model.size]
    loose = std > VAGUE * fit.model.scale[: fit.model.size]
    names = [each.effect for each in fit.model.hypothesis.parameters]
    return tuple(dict.fromkeys(name for name, is_loose in zip(names, loose, strict=True) if is_loose))


def with_own_nuisances(model: Model, point: Point) -> Evaluation:
    """Evaluation of held-out tests after steps of their nuisance parameters alone."""
    held, nothing = model.holding(slice(None), point.x), np.zeros(point.x.size)
    evaluation = model.evaluate(point)
    for _ in range(GAUSS_NEWTON):
        if not evaluation.found:
            break
        equations = normal_equations(held, evaluation)
        step = equations.local_step(nothing, 0.0)[:, equations.eliminated :]
        step = np.clip(model.data.predicted_nuisances(evaluation, step), -LOCAL_STEP, LOCAL_STEP)
        evaluation = model.evaluate(evaluation.point.moved(nothing, step))
    return evaluation
