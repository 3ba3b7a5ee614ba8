"""Trials of a suspect: its recordings at 20 and 30 Hz from rest, and its sweep upwards in frequency."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from wedgesweep.reproduce import observations
from wedgesweep.reproduce.observations import FAST_HERTZ, OBSERVATIONS, OF_TESTS, SLOW_HERTZ, Recording
from wedgesweep.reproduce.suspects import Law, Reading, Suspect
from wedgesweep.solvers import periodic
from wedgesweep.solvers.periodic import Periodic


class Accuracy(NamedTuple):
    """Change of the state that counts as steady, periods after which it is told as it is, rtol of a step."""

    tolerance: float
    most_periods: int
    rtol: float


# A search asks for tenths of tolerances; what is told of its outcome is computed again.
ROUGH, FINE = Accuracy(1e-5, 80, 1e-6), Accuracy(1e-7, 1000, 1e-8)
SAMPLES_PER_PERIOD, HARMONICS = 256, 40
# What an observation that is met costs at the edge of its tolerance: its middle is the better answer.
EDGE = 0.01


@dataclass(frozen=True)
class Question:
    """A suspect under a law, a lean (deg) and a reading of the inputs."""

    suspect: Suspect
    law: Law
    lean: float
    reading: Reading

    @property
    def free(self) -> int:
        """How many numbers are free: the inputs first, then the suspect's own."""
        return self.reading.inputs + len(self.suspect.free)

    def inputs(self, points: np.ndarray, hertz: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Amplitudes (m) of the recordings, (n, 2), and of the sweep, (n, f), at points (n, free)."""
        return self.reading.amplitudes(points[:, : self.reading.inputs], hertz)

    def records(self, points: np.ndarray) -> np.ndarray:
        """Parameter records without amplitude and frequency, shape (n,)."""
        own = points[:, self.reading.inputs :]
        rows = [self.suspect.record(self.law, self.lean, shares) for shares in own]
        return np.concatenate(rows)


def at(records: np.ndarray, hertz: float, amplitude: np.ndarray) -> np.ndarray:
    """The records at a frequency and with their amplitudes (m), shape (n,)."""
    rows = records.copy()
    rows["omega"], rows["amplitude"] = 2.0 * np.pi * hertz, amplitude
    return rows


def respond(
    records: np.ndarray, accuracy: Accuracy, before: Periodic | None = None, harmonics: int = HARMONICS
) -> Periodic:
    """Steady responses, from rest or from the states of others; shape (n,).

    One with a negative normal force at any time, at which a real wedge would lift off, has no numbers.
    """
    warm = periodic.at_rest(len(records)) if before is None else before.warm
    tolerance, most, rtol = accuracy
    found = periodic.respond(records, warm, tolerance, most, SAMPLES_PER_PERIOD, harmonics, rtol, forces=True)
    lifts = found.lifted > 0.0
    found.spectra[lifts], found.extremes[lifts] = np.nan, np.nan
    return found


def record(records: np.ndarray, amplitudes: np.ndarray, accuracy: Accuracy) -> tuple[Recording, Recording]:
    """The recordings at 20 and 30 Hz, each from rest; ``amplitudes`` (m) has shape (n, 2)."""
    slow = respond(at(records, SLOW_HERTZ, amplitudes[:, 0]), accuracy)
    fast = respond(at(records, FAST_HERTZ, amplitudes[:, 1]), accuracy)
    return _recorded(slow), _recorded(fast)


def _recorded(found: Periodic) -> Recording:
    """What a recording shows; no numbers where the periods differ, as the spectra are those of their mean."""
    shows = (found.warm.period == 1) & np.isfinite(found.extremes).all(axis=1)
    numbers = observations.recording(found.spectra, found.extremes)
    return Recording(*(np.where(shows, each, np.nan) for each in numbers))


def sweep(records: np.ndarray, amplitudes: np.ndarray, hertz: np.ndarray, accuracy: Accuracy) -> np.ndarray:
    """Peak-to-peak (mm) of a sweep upwards, each frequency from the state of the one before; (n, f).

    ``amplitudes`` (m) has shape (n, f).
    """
    levels = np.empty(amplitudes.shape)
    before = None
    for column, frequency in enumerate(hertz):
        before = respond(at(records, frequency, amplitudes[:, column]), accuracy, before, harmonics=1)
        levels[:, column] = 1e3 * (before.extremes[:, 1] - before.extremes[:, 0])
    return levels


def distances(
    question: Question, points: np.ndarray, hertz: np.ndarray, limit: np.ndarray | None = None
) -> np.ndarray:
    """Distances (n, observations) at points (n, free).

    The sweep, which costs most, is left out and infinitely far where the recordings alone bring a loss of
    ``limit`` (n,) or more; without a limit for the worse half of the points.
    """
    records = question.records(points)
    tested, swept = question.inputs(points, hertz)
    found = np.full((len(points), len(OBSERVATIONS)), np.inf)
    found[:, :OF_TESTS] = observations.of_tests(*record(records, tested, ROUGH))
    reached = loss(found[:, :OF_TESTS])
    worth = reached <= np.median(reached) if limit is None else reached < limit
    if worth.any():
        levels = sweep(records[worth], swept[worth], hertz, ROUGH)
        found[worth, OF_TESTS:] = observations.of_sweep(hertz, levels)
    return found


def loss(found: np.ndarray) -> np.ndarray:
    """What a search makes small: how many observations are missed, each by its distance; shape (n,).

    A miss costs at most 1: to meet one more is better than to come a little closer to two.
    """
    missed = 1.0 - 1.0 / (1.0 + np.maximum(found - 1.0, 0.0))
    return (missed + EDGE * np.minimum(found, 1.0)).sum(axis=1)


def met(found: np.ndarray) -> np.ndarray:
    """How many observations are met, shape (n,)."""
    return (found <= 1.0).sum(axis=1)


def described(question: Question, point: Sequence[float]) -> dict[str, float]:
    """The free numbers of a point as a person reads them: inputs in mm, others as a config writes them."""
    row = np.asarray(point)[None]
    tested, swept = question.inputs(row, np.array([SLOW_HERTZ, 2.0 * SLOW_HERTZ]))
    inputs = dict(
        zip(
            ("amplitude_20_hz_mm", "amplitude_30_hz_mm", "sweep_20_hz_mm", "sweep_40_hz_mm"),
            [1e3 * float(each) for each in (*tested[0], *swept[0])],
            strict=True,
        )
    )
    return inputs | question.suspect.keys(row[0, question.reading.inputs :].tolist())
