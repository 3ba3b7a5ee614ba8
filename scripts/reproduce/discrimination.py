"""The test that best discriminates between hypotheses which explain the experiment equally well.

Each hypothesis is represented by several of its equally good points. A test has a known input and a free
start phase. The distance of two predictions is that of their harmonics of displacement over the noise, which
is 4 % of the larger motion on each harmonic.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from reproduce.scenarios import LOOSE, excited, respond
from reproduce.search import SearchResult

NOISE = 0.04
LEAST_MOTION = 1e-5  # m; a smaller motion has the noise of one of this size
# Frequencies (Hz) and amplitudes (m) of the tests that are considered, shape (t,).
HERTZ, AMPLITUDES = map(
    np.ravel, np.meshgrid(np.arange(10.0, 41.0, 5.0), np.geomspace(0.01e-3, 1e-3, 9), indexing="ij")
)
HARMONICS = 9
REPRESENTATIVES = 5


@dataclass(frozen=True)
class Discrimination:
    """A test (Hz, m) and the distance of two hypotheses at their closest points, in units of the noise."""

    hypotheses: tuple[str, str]
    hertz: float
    amplitude: float
    distance: float


def discriminate(rivals: Sequence[SearchResult]) -> tuple[list[Discrimination], Discrimination]:
    """The best test for each pair of hypotheses (two or more), and the best for the closest of all pairs."""
    predictions = [_predictions(result) for result in rivals]
    names = list(combinations((result.scenario.hypothesis.name for result in rivals), 2))
    distances = np.stack([smallest_distance(*pair) for pair in combinations(predictions, 2)])
    pairs = [
        _discrimination(pair, int(row.argmax()), row) for pair, row in zip(names, distances, strict=True)
    ]
    test = int(distances.min(axis=0).argmax())
    closest = int(distances[:, test].argmin())
    return pairs, _discrimination(names[closest], test, distances[closest])


def _discrimination(names: tuple[str, str], test: int, distances: np.ndarray) -> Discrimination:
    return Discrimination(names, float(HERTZ[test]), float(AMPLITUDES[test]), float(distances[test]))


def _predictions(result: SearchResult) -> np.ndarray:
    """Complex harmonics of displacement (m) at some equally good points, (points, tests, HARMONICS)."""
    points = result.equally_good
    some = np.linspace(0, len(points) - 1, min(REPRESENTATIVES, len(points))).astype(int)
    records, tests = result.scenario.records(points[some]), zip(HERTZ, AMPLITUDES, strict=True)
    rows = np.concatenate([excited(records, f, np.full(len(records), a)) for f, a in tests])
    harmonics = respond(rows, LOOSE, harmonics=HARMONICS).spectra[:, 0]
    return harmonics.reshape(HERTZ.size, len(records), HARMONICS).swapaxes(0, 1)


def smallest_distance(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Distance (t,) of the closest points in each test; 0 where a response does not exist."""
    found = np.stack([distance(a, b) for a in first for b in second])
    return np.nan_to_num(found, nan=0.0).min(axis=0)


def distance(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Distance (t,) of harmonics (t, h) in units of the noise, with the fundamentals in phase."""
    orders = np.arange(1, first.shape[1] + 1)
    turn = np.angle(first[:, :1]) - np.angle(second[:, :1])
    gap = np.linalg.norm(first - second * np.exp(1j * orders * turn), axis=1)
    size = np.maximum(np.linalg.norm(first, axis=1), np.linalg.norm(second, axis=1))
    return gap / (NOISE * np.maximum(size, LEAST_MOTION))
