"""Scenarios of the experiment: the recordings at 20 and 30 Hz from rest, and the upward frequency sweep."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reproduce import observations
from reproduce.hypotheses import Hypothesis, Interpretation, Law
from reproduce.observations import FAST_HERTZ, OBSERVATIONS, OF_TESTS, SLOW_HERTZ, Recording
from wedgesweep.solvers import periodic
from wedgesweep.solvers.periodic import Accuracy, Periodic
from wedgesweep.systems.records import stacked

# A search needs tenths of tolerances only; its results are computed again.
LOOSE, TIGHT = Accuracy(1e-5, 80, 1e-6), Accuracy(1e-7, 1000, 1e-8)
SAMPLES_PER_PERIOD, HARMONICS = 256, 40
# Loss of a satisfied observation at the edge of its tolerance: the middle is preferred.
EDGE = 0.01


@dataclass(frozen=True)
class Scenario:
    """A hypothesis under a friction law, a column angle (deg) and an interpretation of the inputs."""

    hypothesis: Hypothesis
    law: Law
    column_angle_deg: float
    interpretation: Interpretation

    @property
    def free(self) -> int:
        """Number of free parameters: first the inputs, then those of the hypothesis."""
        return self.interpretation.inputs + len(self.hypothesis.free)

    def inputs(self, points: np.ndarray, hertz: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Amplitudes (m) of the recordings, (n, 2), and of the sweep, (n, f), at points (n, free)."""
        return self.interpretation.amplitudes(points[:, : self.interpretation.inputs], hertz)

    def records(self, points: np.ndarray) -> np.ndarray:
        """Parameter records without amplitude and frequency, shape (n,)."""
        own = points[:, self.interpretation.inputs :]
        rows = [self.hypothesis.record(self.law, self.column_angle_deg, shares) for shares in own]
        return stacked(rows)

    def labels(self) -> dict[str, str | float]:
        """What the scenario is, by the words of the report."""
        return {
            "hypothesis": self.hypothesis.name,
            "law": self.law.name,
            "column_angle_deg": self.column_angle_deg,
            "interpretation": self.interpretation.name,
        }

    def parameters(self, point: Sequence[float]) -> dict[str, float]:
        """The free parameters of a point: amplitudes of the inputs in mm, others as in a config."""
        row = np.asarray(point)[None]
        recorded, swept = self.inputs(row, np.array([SLOW_HERTZ, 2.0 * SLOW_HERTZ]))
        names = ("amplitude_20_hz_mm", "amplitude_30_hz_mm", "sweep_20_hz_mm", "sweep_40_hz_mm")
        inputs = dict(zip(names, (1e3 * np.r_[recorded[0], swept[0]]).tolist(), strict=True))
        return inputs | self.hypothesis.keys(row[0, self.interpretation.inputs :].tolist())


@dataclass(frozen=True)
class EvaluatedPoint:
    """A point (free,) of a scenario and its distances (observations,)."""

    scenario: Scenario
    point: np.ndarray
    distances: np.ndarray

    @property
    def satisfied(self) -> int:
        return int(satisfied(self.distances[None])[0])

    @property
    def loss(self) -> float:
        return float(loss(self.distances[None])[0])


def excited(records: np.ndarray, hertz: float, amplitude: np.ndarray) -> np.ndarray:
    """The records at a frequency and with amplitudes (m), shape (n,)."""
    rows = records.copy()
    rows["input"]["omega"], rows["input"]["amplitude"] = 2.0 * np.pi * hertz, amplitude
    return rows


def respond(
    records: np.ndarray, accuracy: Accuracy, before: Periodic | None = None, harmonics: int = HARMONICS
) -> Periodic:
    """Steady responses, shape (n,), from rest or from the states of other responses.

    A response with a negative normal force at any time, where a real wedge would lift off, is NaN.
    """
    warm = periodic.at_rest(len(records)) if before is None else before.warm
    found = periodic.respond(records, warm, accuracy, SAMPLES_PER_PERIOD, harmonics, forces=True)
    lifts = found.lifted > 0.0
    found.spectra[lifts], found.extremes[lifts] = np.nan, np.nan
    return found


def recordings(
    records: np.ndarray, amplitudes: np.ndarray, accuracy: Accuracy
) -> tuple[Recording, Recording]:
    """The recordings at 20 and 30 Hz, each from rest; ``amplitudes`` (m) has shape (n, 2)."""
    slow = respond(excited(records, SLOW_HERTZ, amplitudes[:, 0]), accuracy)
    fast = respond(excited(records, FAST_HERTZ, amplitudes[:, 1]), accuracy)
    return _recording(slow), _recording(fast)


def _recording(found: Periodic) -> Recording:
    """NaN where the periods differ, as the spectra are those of the mean period."""
    valid = (found.warm.period == 1) & np.isfinite(found.extremes).all(axis=1)
    numbers = observations.recording(found.spectra, found.extremes)
    return Recording(*(np.where(valid, each, np.nan) for each in numbers))


def sweep(records: np.ndarray, amplitudes: np.ndarray, hertz: np.ndarray, accuracy: Accuracy) -> np.ndarray:
    """Peak-to-peak (mm), shape (n, f), of an upward sweep; each frequency starts from the state before.

    ``amplitudes`` (m) has shape (n, f).
    """
    levels = np.empty(amplitudes.shape)
    before = None
    for column, frequency in enumerate(hertz):
        before = respond(excited(records, frequency, amplitudes[:, column]), accuracy, before, harmonics=1)
        levels[:, column] = 1e3 * (before.extremes[:, 1] - before.extremes[:, 0])
    return levels


def distances(
    scenario: Scenario, points: np.ndarray, hertz: np.ndarray, limit: np.ndarray | None = None
) -> np.ndarray:
    """Distances (n, observations) at points (n, free).

    The sweep costs most. It is skipped, and its distances are infinite, where the loss of the recordings
    alone is ``limit`` (n,) or more; without a limit, for the worse half of the points.
    """
    records = scenario.records(points)
    recorded, swept = scenario.inputs(points, hertz)
    found = np.full((len(points), len(OBSERVATIONS)), np.inf)
    found[:, :OF_TESTS] = observations.of_tests(*recordings(records, recorded, LOOSE))
    reached = loss(found[:, :OF_TESTS])
    promising = reached <= np.median(reached) if limit is None else reached < limit
    if promising.any():
        levels = sweep(records[promising], swept[promising], hertz, LOOSE)
        found[promising, OF_TESTS:] = observations.of_sweep(hertz, levels)
    return found


def loss(distances: np.ndarray) -> np.ndarray:
    """Loss of distances (n, observations) that a search minimises, shape (n,).

    A missed observation costs at most 1, so that satisfying one more is better than approaching two.
    """
    missed = 1.0 - 1.0 / (1.0 + np.maximum(distances - 1.0, 0.0))
    return (missed + EDGE * np.minimum(distances, 1.0)).sum(axis=1)


def satisfied(distances: np.ndarray) -> np.ndarray:
    """Number of satisfied observations, shape (n,)."""
    return (distances <= 1.0).sum(axis=1)
