"""Input amplitudes where none is known: a ladder, from far below the fundamental of the displacement."""

from collections.abc import Sequence
from dataclasses import replace
from math import log

import numpy as np

from wedgesweep.diagnose.model import Model, Point, Trial

# Lowest rung, over the fundamental of the displacement, and the factor from one to the next.
LOWEST, STEP = 0.12, 1.3
# Rungs, and how many there are at the most, as long as the bolster sticks in some test.
USUAL, MOST = 17, 28
# Steps between the rungs at which a bolster sticks and moves too much.
BETWEEN = 8


def best_amplitudes(model: Model, points: Sequence[Point]) -> list[Trial]:
    """Simulated points, with the unknown input amplitudes that suit each of them best."""
    if not np.isinf(model.problem.amplitude_std).any():
        return model.trials(points)
    ladder = _Ladder(model, points)
    for rung in range(MOST):
        if rung >= USUAL and not ladder.sticking.any():
            break
        ladder.climb(np.full(ladder.least.shape, log(LOWEST) + rung * log(STEP)))
    if ladder.best_sticks.any():
        ladder.climb_between()
    return model.trials(ladder.best)


class _Ladder:
    """Points (n) on their way up, and the best of each test so far: its misfit ``least`` (n, T).

    ``sticking`` (n, T): whether a test sticks on this rung; ``best_sticks`` (n, T): whether it does on its
    best one; ``held`` (n, T): highest rung (logarithm) on which it did.
    """

    def __init__(self, model: Model, points: Sequence[Point]) -> None:
        self.model, self.best, self.climbing = model, list(points), list(points)
        self.unknown = np.isinf(model.problem.amplitude_std)
        shape = len(points), model.problem.tests
        self.least, self.held = np.full(shape, np.inf), np.full(shape, -np.inf)
        self.sticking, self.best_sticks = np.zeros(shape, bool), np.zeros(shape, bool)

    def climb(self, rungs: np.ndarray) -> None:
        """Try the rungs (n, T), each from the response of the one before."""
        at = [
            replace(each, amplitude=np.where(self.unknown, rung, each.amplitude))
            for each, rung in zip(self.climbing, rungs, strict=True)
        ]
        trials = self.model.trials(at)
        self.climbing = [trial.point for trial in trials]
        self.sticking = np.array([self.model.sticks(trial) for trial in trials]) & self.unknown
        self.held[self.sticking] = rungs[self.sticking]
        for i, trial in enumerate(trials):
            misfit = np.where(trial.found_tests, trial.by_test, np.inf)
            better = misfit < self.least[i]
            self.least[i, better] = misfit[better]
            self.best_sticks[i, better] = self.sticking[i, better]
            self.best[i] = _tests_of(self.best[i], trial.point, better)

    def climb_between(self) -> None:
        """Next to breakaway motion grows so fast that a whole rung leads from too little to far too much."""
        self.climbing = list(self.best)
        amplitudes = np.array([each.amplitude for each in self.best])
        between, held = self.best_sticks.copy(), self.held.copy()
        for step in range(1, BETWEEN):
            self.climb(np.where(between, held + step / BETWEEN * log(STEP), amplitudes))


def _tests_of(one: Point, other: Point, chosen: np.ndarray) -> Point:
    """A point with the amplitudes and states of some tests from another."""
    amplitude = np.where(chosen, other.amplitude, one.amplitude)
    return replace(one, amplitude=amplitude, warm=one.warm.where(chosen, other.warm))
