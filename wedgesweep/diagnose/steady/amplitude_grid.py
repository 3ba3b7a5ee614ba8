"""Input amplitudes where none is known: a ladder, from far below the fundamental of the displacement."""

from collections.abc import Sequence
from dataclasses import replace
from math import log

import numpy as np

from wedgesweep.diagnose.steady.model import Evaluation, Model, Point

# Lowest rung, over the fundamental of the displacement, and the factor from one to the next.
LOWEST, STEP = 0.12, 1.3
# Rungs, and how many there are at the most, as long as the bolster sticks in some test.
USUAL, MOST = 17, 28
# Steps between the rungs at which a bolster sticks and moves too much.
BETWEEN = 8


def best_amplitudes(model: Model, points: Sequence[Point]) -> list[Evaluation]:
    """Simulated points, with the unknown input amplitudes that suit each of them best."""
    if not np.isinf(model.data.amplitude_std).any():
        return model.evaluate_all(points)
    search = _AmplitudeGridSearch(model, points)
    for level in range(MOST):
        if level >= USUAL and not search.sticking.any():
            break
        search.evaluate_level(np.full(search.least.shape, log(LOWEST) + level * log(STEP)))
    if search.best_sticks.any():
        search.refine_near_breakaway()
    return model.evaluate_all(search.best)


class _AmplitudeGridSearch:
    """Points (n) on their way up, and the best of each test so far: its misfit ``least`` (n, T).

    ``sticking`` (n, T): whether a test sticks on this rung; ``best_sticks`` (n, T): whether it does on its
    best one; ``held`` (n, T): highest rung (logarithm) on which it did.
    """

    def __init__(self, model: Model, points: Sequence[Point]) -> None:
        self.model, self.best, self.current = model, list(points), list(points)
        self.unknown = np.isinf(model.data.amplitude_std)
        shape = len(points), model.data.tests
        self.least, self.held = np.full(shape, np.inf), np.full(shape, -np.inf)
        self.sticking, self.best_sticks = np.zeros(shape, bool), np.zeros(shape, bool)

    def evaluate_level(self, levels: np.ndarray) -> None:
        """Try the rungs (n, T), each from the response of the one before."""
        at = [
            replace(each, amplitude=np.where(self.unknown, level, each.amplitude))
            for each, level in zip(self.current, levels, strict=True)
        ]
        evaluations = self.model.evaluate_all(at)
        self.current = [evaluation.point for evaluation in evaluations]
        self.sticking = np.array([self.model.sticks(evaluation) for evaluation in evaluations]) & self.unknown
        self.held[self.sticking] = levels[self.sticking]
        for i, evaluation in enumerate(evaluations):
            misfit = np.where(evaluation.found_tests, evaluation.chi2_by_test, np.inf)
            better = misfit < self.least[i]
            self.least[i, better] = misfit[better]
            self.best_sticks[i, better] = self.sticking[i, better]
            self.best[i] = _tests_of(self.best[i], evaluation.point, better)

    def refine_near_breakaway(self) -> None:
        """Next to breakaway motion grows so fast that a whole rung leads from too little to far too much."""
        self.current = list(self.best)
        amplitudes = np.array([each.amplitude for each in self.best])
        between, held = self.best_sticks.copy(), self.held.copy()
        for step in range(1, BETWEEN):
            self.evaluate_level(np.where(between, held + step / BETWEEN * log(STEP), amplitudes))


def _tests_of(one: Point, other: Point, chosen: np.ndarray) -> Point:
    """A point with the amplitudes and states of some tests from another."""
    amplitude = np.where(chosen, other.amplitude, one.amplitude)
    return replace(one, amplitude=amplitude, warm=one.warm.where(chosen, other.warm))
