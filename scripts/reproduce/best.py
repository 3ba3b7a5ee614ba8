"""A hypothesis at its best point, computed accurately for the report."""

from dataclasses import dataclass

import numpy as np

from reproduce import observations
from reproduce.observations import Recording
from reproduce.scenarios import LOOSE, TIGHT, EvaluatedPoint, Scenario, recordings, sweep
from reproduce.scenarios import loss as loss_of
from reproduce.scenarios import satisfied as number_satisfied
from reproduce.search import SearchResult
from wedgesweep.solvers.periodic import Accuracy

HERTZ = np.arange(20.0, 41.0)
# Points of a search that are compared again: the search used every second frequency of the sweep only.
COMPARED = 50


@dataclass(frozen=True)
class Best(EvaluatedPoint):
    """The best point of a search, with recordings and sweep (peak-to-peak in mm over HERTZ)."""

    result: SearchResult
    slow: Recording
    fast: Recording
    sweep: np.ndarray


def computed(result: SearchResult) -> Best:
    """Compute the best point of a search accurately, at all frequencies of the sweep."""
    points = result.equally_good[:COMPARED]
    *_, distances = _simulated(result.scenario, points, LOOSE)
    best = points[np.lexsort((loss_of(distances), -number_satisfied(distances)))[:1]]
    slow, fast, levels, distances = _simulated(result.scenario, best, TIGHT)
    return Best(result.scenario, best[0], distances[0], result, slow, fast, levels[0])


def _simulated(
    scenario: Scenario, points: np.ndarray, accuracy: Accuracy
) -> tuple[Recording, Recording, np.ndarray, np.ndarray]:
    """Recordings, sweep (mm) and distances at points (n, free)."""
    records = scenario.records(points)
    recorded, swept = scenario.inputs(points, HERTZ)
    slow, fast = recordings(records, recorded, accuracy)
    levels = sweep(records, swept, HERTZ, accuracy)
    parts = [observations.of_tests(slow, fast), observations.of_sweep(HERTZ, levels)]
    return slow, fast, levels, np.concatenate(parts, axis=1)
