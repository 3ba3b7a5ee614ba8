"""A suspect at its best point, computed finely: what the search found, as it is told."""

from dataclasses import dataclass

import numpy as np

from wedgesweep.reproduce import observations
from wedgesweep.reproduce.observations import Recording
from wedgesweep.reproduce.search import Found
from wedgesweep.reproduce.trials import FINE, ROUGH, loss, met, record, sweep

HERTZ = np.arange(20.0, 41.0)
# Points of a search that are looked at again: it had only every other frequency of the sweep.
FIRST = 50


@dataclass(frozen=True)
class Case:
    """A suspect at its best point, computed finely: what it shows, and its distances (observations,)."""

    found: Found
    point: np.ndarray  # (free,)
    slow: Recording
    fast: Recording
    sweep: np.ndarray  # peak-to-peak (mm) over HERTZ
    distances: np.ndarray

    @property
    def met(self) -> int:
        return int(met(self.distances[None])[0])

    @property
    def loss(self) -> float:
        return float(loss(self.distances[None])[0])


def computed(found: Found) -> Case:
    """Compute the outcome of a search finely, at the first frequency of the sweep and all in between."""
    point = _best(found)[None]
    records = found.question.records(point)
    tested, swept = found.question.inputs(point, HERTZ)
    slow, fast = record(records, tested, FINE)
    levels = sweep(records, swept, HERTZ, FINE)
    return Case(found, point[0], slow, fast, levels[0], _distances(slow, fast, levels)[0])


def _best(found: Found) -> np.ndarray:
    """The best of the first points, (free,), by all frequencies of the sweep."""
    points = found.alike[:FIRST]
    records = found.question.records(points)
    tested, swept = found.question.inputs(points, HERTZ)
    distances = _distances(*record(records, tested, ROUGH), sweep(records, swept, HERTZ, ROUGH))
    return points[np.lexsort((loss(distances), -met(distances)))[0]]


def _distances(slow: Recording, fast: Recording, levels: np.ndarray) -> np.ndarray:
    return np.concatenate([observations.of_tests(slow, fast), observations.of_sweep(HERTZ, levels)], axis=1)
