"""The measurement that would tell suspects apart which all fit what is known.

Each suspect stands for all its points that fit as well. A new test has a known input; its start phase is
free. Two predictions are as far apart as their harmonics of displacement, in units of the noise: 4 % of the
larger motion, on each harmonic.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from wedgesweep.reproduce.search import Found
from wedgesweep.reproduce.trials import ROUGH, at, respond

NOISE = 0.04
LEAST_MOTION = 1e-5  # m; below it the noise is that of a motion of this size
HERTZ = np.arange(10.0, 41.0, 5.0)
# Amplitudes of the new test (m).
AMPLITUDES = np.geomspace(0.01e-3, 1e-3, 9)
HARMONICS = 9
MEMBERS = 5  # points that stand for a suspect


@dataclass(frozen=True)
class Separation:
    """A test (Hz, m) and how far it puts two suspects apart (noise units), even at their closest points."""

    suspects: tuple[str, str]
    hertz: float
    amplitude: float
    distance: float


def separate(rivals: Sequence[Found]) -> tuple[list[Separation], Separation]:
    """The best test for each pair of suspects, and the one that is best for the closest of all pairs.

    Takes two suspects or more.
    """
    predictions = [_predictions(found) for found in rivals]
    pairs = list(combinations(range(len(rivals)), 2))
    distances = np.stack([closest(predictions[i], predictions[j]) for i, j in pairs])
    names = [(rivals[i].question.suspect.name, rivals[j].question.suspect.name) for i, j in pairs]
    best = [_separation(names[k], int(np.argmax(row)), row) for k, row in enumerate(distances)]
    test = int(np.argmax(distances.min(axis=0)))
    hardest = int(np.argmin(distances[:, test]))
    return best, _separation(names[hardest], test, distances[hardest])


def _separation(names: tuple[str, str], test: int, distances: np.ndarray) -> Separation:
    hertz, amplitude = _tests()
    return Separation(names, float(hertz[test]), float(amplitude[test]), float(distances[test]))


def _tests() -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (Hz) and amplitudes (m) of all tests, shape (t,)."""
    hertz, amplitude = np.meshgrid(HERTZ, AMPLITUDES, indexing="ij")
    return hertz.ravel(), amplitude.ravel()


def members(found: Found) -> np.ndarray:
    """The best point and some that meet as much, shape (m, free)."""
    return found.alike[np.linspace(0, len(found.alike) - 1, min(MEMBERS, len(found.alike))).astype(int)]


def _predictions(found: Found) -> np.ndarray:
    """Harmonics of displacement (m), complex, shape (members, tests, HARMONICS)."""
    records = found.question.records(members(found))
    hertz, amplitude = _tests()
    tests = zip(hertz, amplitude, strict=True)
    rows = np.concatenate([at(records, f, np.full(len(records), a)) for f, a in tests])
    harmonics = respond(rows, ROUGH, harmonics=HARMONICS).spectra[:, 0]
    return harmonics.reshape(hertz.size, len(records), HARMONICS).swapaxes(0, 1)


def closest(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Distance of the closest members in each test, shape (t,); 0 where one has no answer."""
    apart = np.stack([distance(a, b) for a in first for b in second])
    return np.nan_to_num(apart, nan=0.0).min(axis=0)


def distance(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Distance (t,) of harmonics (t, h) in noise units, the fundamentals turned into one direction."""
    orders = np.arange(1, first.shape[1] + 1)
    turn = np.angle(first[:, :1]) - np.angle(second[:, :1])
    gap = np.linalg.norm(first - second * np.exp(1j * orders * turn), axis=1)
    size = np.maximum(np.linalg.norm(first, axis=1), np.linalg.norm(second, axis=1))
    return gap / (NOISE * np.maximum(size, LEAST_MOTION))
