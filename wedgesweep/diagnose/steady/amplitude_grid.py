"""Input amplitudes that are unknown: a grid search from far below the fundamental of the displacement."""

from collections.abc import Sequence
from dataclasses import replace
from math import log

import numpy as np

from wedgesweep.diagnose.evaluation import Evaluation, Point
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.model import Model

# Lowest level, over the fundamental of the displacement, and the factor from one level to the next.
LOWEST, FACTOR = 0.12, 1.3
# Number of levels, and the largest number where the bolster still sticks in some test.
LEVELS, MOST_LEVELS = 17, 28
# A bolster that moves less than this share of the measured motion sticks.
STICKS = 0.01
# Steps between the level at which the bolster sticks and the next one.
FINE = 8


def best_amplitudes(model: Model, points: Sequence[Point]) -> list[Evaluation]:
    """Evaluations of points, the unknown input amplitudes being those that fit each of them best."""
    if not np.isinf(model.data.nuisance_std).any():
        return model.evaluate_all(points)
    search = _GridSearch(model, points)
    for level in range(MOST_LEVELS):
        if level >= LEVELS and not search.sticking.any():
            break
        search.evaluate(np.full(search.least.shape, log(LOWEST) + level * log(FACTOR)))
    if search.best_sticks.any():
        search.refine_near_breakaway()
    return model.evaluate_all(search.best)


class _GridSearch:
    """Points (n) whose amplitudes rise from level to level, and the best amplitude of each test so far.

    ``least`` (n, T): misfit of the best one; ``sticking`` (n, T): whether a test sticks at the present
    level; ``best_sticks`` (n, T): whether it does at its best one; ``stuck`` (n, T): highest level
    (logarithm) of those at which it did.
    """

    def __init__(self, model: Model, points: Sequence[Point]) -> None:
        self.model, self.best, self.current = model, list(points), list(points)
        self.unknown = np.isinf(model.data.nuisance_std[:, 0])
        shape = len(points), model.data.tests
        self.least, self.stuck = np.full(shape, np.inf), np.full(shape, -np.inf)
        self.sticking, self.best_sticks = np.zeros(shape, bool), np.zeros(shape, bool)

    def evaluate(self, levels: np.ndarray) -> None:
        """Evaluate the levels (n, T), starting from the responses at those before."""
        points = [
            replace(each, nuisance=np.where(self.unknown, level, each.nuisance[:, 0])[:, None])
            for each, level in zip(self.current, levels, strict=True)
        ]
        evaluations = self.model.evaluate_all(points)
        self.current = [each.point for each in evaluations]
        self.sticking = np.array([_sticks(self.model.data, each) for each in evaluations]) & self.unknown
        self.stuck[self.sticking] = levels[self.sticking]
        for i, each in enumerate(evaluations):
            misfit = np.where(each.found_tests, each.chi2_by_test, np.inf)
            better = misfit < self.least[i]
            self.least[i, better] = misfit[better]
            self.best_sticks[i, better] = self.sticking[i, better]
            self.best[i] = _tests_of(self.best[i], each.point, better)

    def refine_near_breakaway(self) -> None:
        """Near breakaway motion grows so fast that one level leads from too little to far too much."""
        self.current = list(self.best)
        amplitudes = np.array([each.nuisance[:, 0] for each in self.best])
        sticks, stuck = self.best_sticks.copy(), self.stuck.copy()
        for step in range(1, FINE):
            self.evaluate(np.where(sticks, stuck + step / FINE * log(FACTOR), amplitudes))


def _tests_of(one: Point, other: Point, chosen: np.ndarray) -> Point:
    """A point with the amplitudes and states of some tests (T,) from another."""
    amplitude = np.where(chosen[:, None], other.nuisance, one.nuisance)
    return replace(one, nuisance=amplitude, warm=one.warm.where(chosen, other.warm))


def _sticks(data: FitData, evaluation: Evaluation) -> np.ndarray:
    """Whether (T,) a test was measured to move, and sticks in the simulation."""
    return evaluation.found_tests & (data.power_of(evaluation.response) < STICKS**2 * data.power)
