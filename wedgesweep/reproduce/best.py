"""A suspect at its best point, computed finely: what the search found, as it is told."""

from dataclasses import dataclass
from math import nan

import numpy as np

from wedgesweep import dataset
from wedgesweep.batch import solve_batch
from wedgesweep.reproduce import observations
from wedgesweep.reproduce.observations import FAST_HERTZ, SLOW_HERTZ, Recording
from wedgesweep.reproduce.search import Found
from wedgesweep.reproduce.trials import FINE, ROUGH, at, loss, met, record, sweep
from wedgesweep.simulate import Settings

HERTZ = np.arange(20.0, 41.0)
# Points of a search that are looked at again: it had only every other frequency of the sweep.
FIRST = 10
SETTINGS = Settings(
    method="event-driven", duration=None, kept_periods=1, steady=True, max_periods=200, keep_waveforms=False
)


@dataclass(frozen=True)
class Case:
    """A suspect at its best point, computed finely: what it shows, and its distances (observations,)."""

    found: Found
    point: np.ndarray  # (free,)
    slow: Recording
    fast: Recording
    sweep: np.ndarray  # peak-to-peak (mm) over HERTZ
    lift_off: float  # longest share of time with a normal force below zero, in recordings and sweep
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
    rows = [at(records, hertz, a) for hertz, a in zip(HERTZ, swept.T, strict=True)]
    rows += [at(records, SLOW_HERTZ, tested[:, 0]), at(records, FAST_HERTZ, tested[:, 1])]
    lift_off = _lift_off(np.concatenate(rows))
    return Case(found, point[0], slow, fast, levels[0], lift_off, _distances(slow, fast, levels)[0])


def _best(found: Found) -> np.ndarray:
    """The best of the first points, (free,), by all frequencies of the sweep."""
    points = found.alike[:FIRST]
    records = found.question.records(points)
    tested, swept = found.question.inputs(points, HERTZ)
    distances = _distances(*record(records, tested, ROUGH), sweep(records, swept, HERTZ, ROUGH))
    return points[np.lexsort((loss(distances), -met(distances)))[0]]


def _distances(slow: Recording, fast: Recording, levels: np.ndarray) -> np.ndarray:
    return np.concatenate([observations.of_tests(slow, fast), observations.of_sweep(HERTZ, levels)], axis=1)


def _lift_off(rows: np.ndarray) -> float:
    """Longest share of time in which a normal force is negative; NaN where nothing slips."""
    dtype = dataset.record_dtype({"phase": 0, "harmonic": dataset.HARMONICS, "part": 2})
    shares = solve_batch(rows, np.arange(len(rows)), SETTINGS, dtype)[0]["lift_off_fraction"]
    return float(np.nanmax(shares)) if np.isfinite(shares).any() else nan
