"""Distances of predictions of tests that nobody made, as data of a fit in which nothing was measured."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.fit_data import Evaluation, Point
from wedgesweep.diagnose.jacobian import jacobian
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.offer import PREDICTED, Offer, covariance_root, least_distance
from wedgesweep.diagnose.sampled_data import SampledData

# A mass whose motion has less than this power over that of its noise sticks: there is nothing to fit.
MOVES = 10.0
# Standard deviations of the noise that a free nuisance parameter may take up.
FREE = 1e4


class Design(NamedTuple):
    """Tests to choose from: ``data`` with A B tests, and the ``numbers`` of each."""

    kind: str
    motion: str | None
    data: SampledData
    numbers: Sequence[Mapping[str, float]]
    shape: tuple[int, int]


class _Prediction(NamedTuple):
    """An evaluation, and its changes (T, m, j) by one standard deviation of everything that is uncertain.

    ``spread``: by parameters; ``adapted``: by the nuisance parameters of a test. ``moves`` (T,): whether
    there is a motion that shows.
    """

    evaluation: Evaluation
    spread: np.ndarray
    adapted: np.ndarray
    moves: np.ndarray


def offered(design: Design, fits: Sequence[Fit]) -> Offer:
    """What the tests of a design separate."""
    predicted = [(fit, _predicted(fit, design.data)) for fit in fits]
    predicted = [each for each in predicted if each[1].evaluation.found_tests.mean() >= PREDICTED]
    pairs = combinations([each for _, each in predicted], 2)
    distances = [_distances(design.data, *pair).reshape(design.shape) for pair in pairs]
    kept = [fit for fit, _ in predicted]
    return Offer(design.kind, design.motion, kept, np.array(distances), design.numbers)


def _predicted(fit: Fit, data: SampledData) -> _Prediction:
    model = replace(fit.model, data=data)
    nuisance, warm = data.start()
    here = model.evaluate(Point(fit.x, nuisance, warm))
    derivatives = jacobian(model, here)
    by_nuisance = derivatives.by_nuisance
    std = np.full((data.tests, by_nuisance.shape[2]), np.inf)
    stated = data.nuisance_std
    std[:, data.eliminated : data.eliminated + stated.shape[1]] = stated
    size = np.linalg.norm(by_nuisance, axis=1)
    std = np.where(np.isinf(std), FREE / np.maximum(size, 1e-300), std)
    moves = replace(data, resampled=here.response).power > MOVES * data.observations  # type: ignore[type-var]
    spread = derivatives.by_parameter @ covariance_root(fit)
    return _Prediction(here, spread, by_nuisance * std[:, None], moves & here.found_tests)


def _distances(data: SampledData, one: _Prediction, other: _Prediction) -> np.ndarray:
    """Squared distances (T,), 0 where a prediction does not exist or a mass sticks.

    Of the two, one is what happens; the other adapts its start, and whatever else is unknown of a test.
    """
    gap = data.response_change(one.evaluation, other.evaluation)
    columns = np.concatenate([one.spread, other.spread, other.adapted], axis=2)
    both = one.moves & other.moves
    return np.array(
        [least_distance(*each) if ok else 0.0 for *each, ok in zip(gap, columns, both, strict=True)]
    )
