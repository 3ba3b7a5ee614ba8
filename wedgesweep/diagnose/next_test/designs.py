"""Distances between predictions of tests that were not made: data of a fit in which nothing was measured."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.cross_validation import GAUSS_NEWTON
from wedgesweep.diagnose.evaluation import Evaluation, Point
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.jacobian import accurate_jacobian
from wedgesweep.diagnose.model import Fit

# Sizes of tests over what was measured.
SIZES = np.array([0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8])
# Least share of the tests on offer that an explanation must predict; at the others its wedge locks.
PREDICTED = 0.5
# Largest standard deviation of a parameter, in its scales.
WIDEST = 10.0
# A mass sticks if the power of its motion is less than this many times that of its noise.
MOVES = 10.0
# Standard deviations of the noise that a free nuisance parameter may take up.
FREE = 1e4


class Design(NamedTuple):
    """Tests to choose from: ``data`` of A B tests, and the ``numbers`` of each; ``shape``: (A, B).

    The data are what the best explanation predicts.
    """

    kind: str
    motion: str | None
    data: FitData
    numbers: Sequence[Mapping[str, float]]
    shape: tuple[int, int]


class _Moved(NamedTuple):
    """Changes of parameters (k + u,), in standard deviations, and of nuisance parameters (N,), from a fit."""

    parameters: np.ndarray
    nuisances: np.ndarray


class _Prediction(NamedTuple):
    """An evaluation, and its changes (T, m, j) by one standard deviation of everything that is uncertain.

    ``spread``: by parameters; ``adapted``: by the nuisance parameters of a test, with their standard
    deviations ``std`` (T, L). ``moves`` (T,): whether there is a motion that shows.
    """

    evaluation: Evaluation
    spread: np.ndarray
    adapted: np.ndarray
    std: np.ndarray
    moves: np.ndarray


class Offer(NamedTuple):
    """The tests of a design, with distances (pairs, A, B) of every two of the fits that predict them."""

    design: Design
    fits: Sequence[Fit]
    distances: np.ndarray

    def adapted(self, test: int) -> np.ndarray:
        """Distances (pairs,) in a test, by its index, with the explanations fitted to one another."""
        own = self.design.data.subset(np.array([test]))
        return np.array([_adapted(own, *pair) for pair in combinations(self.fits, 2)])


def offered(design: Design, fits: Sequence[Fit]) -> Offer:
    """The tests of a design, with the distances of the explanations that predict them."""
    predicted = [(fit, _predicted(fit, design.data)) for fit in fits]
    predicted = [each for each in predicted if each[1].evaluation.found_tests.mean() >= PREDICTED]
    pairs = combinations([each for _, each in predicted], 2)
    distances = [_distances(*pair).reshape(design.shape) for pair in pairs]
    return Offer(design, [fit for fit, _ in predicted], np.array(distances))


def _predicted(fit: Fit, data: FitData, moved: _Moved | None = None) -> _Prediction:
    model, root = fit.model.on(data), covariance_root(fit)
    point = Point(fit.x, *data.start())
    if moved is not None:
        x = np.clip(point.x + root @ moved.parameters, model.low, model.high)
        point = replace(point, x=x).moved(np.zeros(x.size), moved.nuisances[None])
    here = model.evaluate(point)
    by_parameter, by_nuisance = accurate_jacobian(model, here)
    std = np.full((data.tests, by_nuisance.shape[2]), np.inf)
    stated = data.nuisance_std
    std[:, data.eliminated : data.eliminated + stated.shape[1]] = stated
    size = np.linalg.norm(by_nuisance, axis=1)
    free = FREE / np.where(size > 0.0, size, FREE)  # what has no influence keeps its size
    std = np.where(np.isinf(std), free, std)
    moves = data.power_of(here.response) > MOVES * data.observations
    spread, adapted = by_parameter @ root, by_nuisance * std[:, None]
    return _Prediction(here, spread, adapted, std, moves & here.found_tests)


def _adapted(data: FitData, one: Fit, other: Fit) -> float:
    """Squared distance of two predictions of a single test, by Gauss-Newton steps.

    Derivatives alone overestimate it where predictions are far from linear in what is uncertain.
    """
    first, second = (_Moved(np.zeros(fit.x.size), _unmoved(data, fit)) for fit in (one, other))
    found = np.inf
    for _ in range(GAUSS_NEWTON):
        mine, its = _predicted(one, data, first), _predicted(other, data, second)
        if not (mine.moves & its.moves).all():
            break
        std = its.std[0]
        spent = np.r_[first.parameters, second.parameters, np.zeros(data.eliminated)]
        spent = np.r_[spent, second.nuisances / std[data.eliminated :]]
        gap = (mine.evaluation.residual - its.evaluation.residual)[0]
        # Derivatives are those of residuals, which fall as responses rise.
        columns = np.concatenate([mine.spread, -its.spread, -its.adapted], axis=2)[0]
        zero = its.adapted[0, :, : data.eliminated]
        left = gap - zero @ np.linalg.lstsq(zero, gap, rcond=None)[0]
        found = min(found, float(left @ left + spent @ spent))
        matrix = np.concatenate([columns, np.eye(spent.size)])
        step = np.linalg.lstsq(matrix, -np.concatenate([gap, spent]), rcond=None)[0]
        k, both = one.x.size, one.x.size + other.x.size
        first = first._replace(parameters=first.parameters + step[:k])
        nuisances = second.nuisances + (step[both:] * std)[data.eliminated :]
        second = _Moved(second.parameters + step[k:both], nuisances)
    return found


def _unmoved(data: FitData, fit: Fit) -> np.ndarray:
    """No step of the nuisance parameters that are fitted beside an explanation, shape (L,)."""
    return np.zeros(len(data.nuisances(fit.effects)))


def _distances(one: _Prediction, other: _Prediction) -> np.ndarray:
    """Squared distances (T,), 0 where a prediction does not exist or a mass sticks.

    Of the two, one is what happens; the other adapts its start, and whatever else is unknown of a test. Both
    residuals are relative to the best explanation, so that their difference is that of the responses.
    """
    gap = one.evaluation.residual - other.evaluation.residual
    columns = np.concatenate([one.spread, other.spread, other.adapted], axis=2)
    both = one.moves & other.moves
    return np.array(
        [least_distance(*each) if ok else 0.0 for *each, ok in zip(gap, columns, both, strict=True)]
    )


def covariance_root(fit: Fit) -> np.ndarray:
    """Root (k + u, k + u) of the covariance of a fit, in which no parameter is wider than its range."""
    std = np.sqrt(np.diag(fit.covariance))
    share = np.minimum(1.0, WIDEST * fit.model.scale / np.maximum(std, 1e-300))
    values, vectors = np.linalg.eigh(fit.covariance * np.outer(share, share))
    return vectors * np.sqrt(np.maximum(values, 0.0))


def least_distance(gap: np.ndarray, columns: np.ndarray) -> float:
    """Squared distance of two predictions when their parameters change so that it is least.

    The squared changes of parameters, in standard deviations, are part of it. ``gap`` (m,): whitened
    difference of the predictions; ``columns`` (m, j): its changes by a standard deviation of each parameter.
    """
    matrix = np.concatenate([columns, np.eye(columns.shape[1])])
    aim = np.concatenate([gap, np.zeros(columns.shape[1])])
    change = np.linalg.lstsq(matrix, aim, rcond=None)[0]
    return float(((aim - matrix @ change) ** 2).sum())
