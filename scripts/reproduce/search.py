"""Search of a scenario by differential evolution (Storn and Price, 1997), with reproducible results.

Distances jump where a motion begins to stick, so that gradients are of no use. A generation is one batch.
Where each recording has an input of its own, every second generation varies only the inputs, one by one.
"""

from dataclasses import dataclass
from hashlib import sha256

import numpy as np

from reproduce.scenarios import EvaluatedPoint, Scenario, distances, loss, satisfied

# Weight of the differences, and the share of the parameters that a trial point takes over.
WEIGHT, CROSSOVER = 0.7, 0.8
SEARCH_HERTZ = np.arange(21.0, 41.0, 2.0)  # of the sweep; 33, 35 and 37 Hz are among them


@dataclass(frozen=True)
class Budget:
    """Points per free parameter, and generations."""

    points: int
    generations: int


# Coarse for all scenarios, medium for the most promising of each hypothesis, fine for its best.
COARSE, MEDIUM, FINE = Budget(6, 6), Budget(10, 14), Budget(20, 60)


@dataclass(frozen=True)
class SearchResult(EvaluatedPoint):
    """The best point found, and all points (m, free) that satisfy as many observations, best first."""

    equally_good: np.ndarray


def search(scenario: Scenario, budget: Budget, start: np.ndarray | None = None) -> SearchResult:
    """Find the point that satisfies the most observations, and of these the one with the smallest loss.

    ``start`` (m, free) are good points that are already known.
    """
    random = np.random.default_rng(_seed(scenario))
    points = _latin_hypercube(budget.points * scenario.free, scenario.free, random)
    if start is not None:
        points[: len(start)] = start[: len(points)]
    found = distances(scenario, points, SEARCH_HERTZ)
    seen = [(points, found)]
    for generation in range(budget.generations):
        by_input = generation % 2 and scenario.interpretation.separate
        select = _select_by_input if by_input else _select
        chosen, found = select(scenario, points, found, _trial_points(points, loss(found), random))
        moved = (chosen != points).any(axis=1)
        seen.append((chosen[moved], found[moved]))
        points = chosen
    return _best(scenario, *(np.concatenate(each) for each in zip(*seen, strict=True)))


def _seed(scenario: Scenario) -> int:
    """A seed of its own, so that no result depends on which other scenarios are searched."""
    names = (
        scenario.hypothesis.name,
        scenario.law.name,
        f"{scenario.column_angle_deg:g}",
        scenario.interpretation.name,
    )
    return int.from_bytes(sha256("/".join(names).encode()).digest()[:4], "big")


def _latin_hypercube(size: int, free: int, random: np.random.Generator) -> np.ndarray:
    """Points (size, free); every parameter takes each of ``size`` parts of its range once."""
    parts = np.stack([random.permutation(size) for _ in range(free)], axis=1)
    return (parts + random.random((size, free))) / size


def _trial_points(points: np.ndarray, losses: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Move each point towards one of the best, add the difference of two others, and cross over."""
    size, free = points.shape
    first, second = (random.integers(size, size=size) for _ in range(2))
    best = points[np.argsort(losses)[random.integers(max(size // 10, 1), size=size)]]
    moved = points + WEIGHT * (best - points) + WEIGHT * (points[first] - points[second])
    taken = random.random((size, free)) < CROSSOVER
    taken[np.arange(size), random.integers(free, size=size)] = True
    trials = np.where(taken, moved, points)
    # Reflected at the ends of the ranges.
    return 1.0 - np.abs(1.0 - np.abs(trials) % 2.0)


def _select(
    scenario: Scenario, points: np.ndarray, found: np.ndarray, trials: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The better of each point and its trial point, and its distances."""
    tried = distances(scenario, trials, SEARCH_HERTZ, loss(found))
    better = (loss(tried) <= loss(found))[:, None]
    return np.where(better, trials, points), np.where(better, tried, found)


def _select_by_input(
    scenario: Scenario, points: np.ndarray, found: np.ndarray, trials: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Points with each input of the trial point that improves what it alone decides, and their distances.

    The sweep is computed for the better half of the points.
    """
    inputs = scenario.interpretation.inputs
    trials = np.hstack([trials[:, :inputs], points[:, inputs:]])
    promising = loss(found) <= np.median(loss(found))
    tried = distances(scenario, trials, SEARCH_HERTZ, np.where(promising, np.inf, -np.inf))
    chosen, distance = points.copy(), found.copy()
    for own, decided in scenario.interpretation.separate:
        better = loss(tried[:, decided]) <= loss(found[:, decided])
        chosen[better, own] = trials[better, own]
        distance[better, decided] = tried[better, decided]
    return chosen, distance


def _best(scenario: Scenario, points: np.ndarray, found: np.ndarray) -> SearchResult:
    count = satisfied(found)
    most = np.flatnonzero(count == count.max())
    most = most[np.argsort(loss(found[most]), kind="stable")]
    return SearchResult(scenario, points[most[0]], found[most[0]], points[most])
