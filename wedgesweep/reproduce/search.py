"""Search of a suspect's ranges: differential evolution (Storn and Price, 1997), the same each time.

Distances jump where a motion begins to stick, so that no gradient is asked for. A generation is one batch.
Where each recording has an input of its own, every other generation looks for these alone, one by one.
"""

from dataclasses import dataclass
from hashlib import sha256

import numpy as np

from wedgesweep.reproduce.trials import Question, distances, loss, met

# Weight of a difference, and share of the numbers that a trial takes over.
WEIGHT, CROSSOVER = 0.7, 0.8
SEARCH_HERTZ = np.arange(21.0, 41.0, 2.0)  # of the sweep; 33, 35 and 37 Hz are among them


@dataclass(frozen=True)
class Effort:
    """Members per free number, and generations."""

    members: int
    generations: int


# All questions are looked through, the most promising of each suspect searched well, and the best one deeply.
THROUGH, WELL, DEEPLY = Effort(6, 6), Effort(10, 14), Effort(20, 60)


@dataclass(frozen=True)
class Found:
    """Outcome of a search: all points that meet the most observations, the closest first."""

    question: Question
    distances: np.ndarray  # (observations,) of the first one
    alike: np.ndarray  # (m, free)

    @property
    def point(self) -> np.ndarray:
        """The best point, (free,)."""
        return self.alike[0]

    @property
    def met(self) -> int:
        return int(met(self.distances[None])[0])

    @property
    def loss(self) -> float:
        return float(loss(self.distances[None])[0])


def search(question: Question, effort: Effort, start: np.ndarray | None = None) -> Found:
    """Look for the point that meets the most observations; the closest one of these.

    ``start`` (m, free) are points that are known to be good.
    """
    random = np.random.default_rng(_seed(question))
    points = _spread(effort.members * question.free, question.free, random)
    if start is not None:
        points[: len(start)] = start[: len(points)]
    found = distances(question, points, SEARCH_HERTZ)
    seen = [(points, found)]
    for generation in range(effort.generations):
        select = _input_by_input if generation % 2 and question.reading.separate else _whole
        chosen, found = select(question, points, found, _trials(points, loss(found), random))
        moved = (chosen != points).any(axis=1)
        seen.append((chosen[moved], found[moved]))
        points = chosen
    return _best(question, *(np.concatenate(each) for each in zip(*seen, strict=True)))


def _seed(question: Question) -> int:
    """A seed of the question's own, so that no answer depends on which others were asked."""
    name = (question.suspect.name, question.law.name, f"{question.lean:g}", question.reading.name)
    return int.from_bytes(sha256("/".join(name).encode()).digest()[:4], "big")


def _spread(size: int, free: int, random: np.random.Generator) -> np.ndarray:
    """Latin hypercube: every number takes each of ``size`` parts of its range once."""
    parts = np.stack([random.permutation(size) for _ in range(free)], axis=1)
    return (parts + random.random((size, free))) / size


def _trials(points: np.ndarray, losses: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Half way from each point to the best one, plus the difference of two others; crossed with the point."""
    size, free = points.shape
    first, second = (random.integers(size, size=size) for _ in range(2))
    best = points[np.argsort(losses)[random.integers(max(size // 10, 1), size=size)]]
    moved = points + WEIGHT * (best - points) + WEIGHT * (points[first] - points[second])
    taken = random.random((size, free)) < CROSSOVER
    taken[np.arange(size), random.integers(free, size=size)] = True
    trials = np.where(taken, moved, points)
    # What leaves the ranges comes back in, as from a mirror.
    return 1.0 - np.abs(1.0 - np.abs(trials) % 2.0)


def _whole(
    question: Question, points: np.ndarray, found: np.ndarray, trials: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The better one of each point and its trial, and its distances."""
    tried = distances(question, trials, SEARCH_HERTZ, loss(found))
    better = (loss(tried) <= loss(found))[:, None]
    return np.where(better, trials, points), np.where(better, tried, found)


def _input_by_input(
    question: Question, points: np.ndarray, found: np.ndarray, trials: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The points with each input of the trial that is better for what it alone decides, and their distances.

    The sweep is computed for the better half of the points.
    """
    trials = np.hstack([trials[:, : question.reading.inputs], points[:, question.reading.inputs :]])
    promising = loss(found) <= np.median(loss(found))
    tried = distances(question, trials, SEARCH_HERTZ, np.where(promising, np.inf, -np.inf))
    chosen, distance = points.copy(), found.copy()
    for inputs, decided in question.reading.separate:
        better = loss(tried[:, decided]) <= loss(found[:, decided])
        chosen[better, inputs] = trials[better, inputs]
        distance[better, decided] = tried[better, decided]
    return chosen, distance


def _best(question: Question, points: np.ndarray, found: np.ndarray) -> Found:
    count = met(found)
    most = np.flatnonzero(count == count.max())
    most = most[np.argsort(loss(found[most]), kind="stable")]
    return Found(question, found[most[0]], points[most])
