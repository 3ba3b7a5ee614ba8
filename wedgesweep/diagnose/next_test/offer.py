"""Choice of a next test: the cheapest of the tests of one kind that separates explanations.

The criterion is T-optimality (Atkinson and Fedorov, 1975, Biometrika 62, 57).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np
from scipy.ndimage import minimum_filter1d

from wedgesweep.diagnose.model import Fit

# Squared distance at which two explanations are separated, and below which they do not differ visibly.
SEPARATED, UNSEEN = 30.0, 1.0
# Least share of the tests on offer that an explanation must predict; at the others its wedge locks.
PREDICTED = 0.5
# Tests that are looked at closely, if explanations adapt to those before.
TRIED = 5
# Largest standard deviation of a parameter, in its scales.
WIDEST = 10.0


class Separation(NamedTuple):
    """Two explanations by name, the better one first, and the squared distance of their predictions."""

    names: tuple[str, str]
    distance: float


@dataclass(frozen=True)
class NextTest:
    """A test to make, and the closest two explanations that it separates.

    ``kind`` of test, for a transient with its ``motion``; ``numbers`` by the keys and in the units of
    diagnosis.json; ``pairs``: how far apart every two of the compared explanations are, the best one's first.
    """

    kind: str
    numbers: Mapping[str, float]
    separates: tuple[str, str]
    distance: float
    pairs: tuple[Separation, ...]
    motion: str | None = None


class Offer(NamedTuple):
    """Tests of one kind to choose from: A sizes, the cheapest first, by B other choices.

    ``fits``: the explanations that predict them; ``distances`` (pairs, A, B): of every two, by derivatives;
    ``numbers``: of each of the A B tests. ``adapted``: gives the distances (pairs,) in a test, by its index,
    with explanations fitted to one another; None where that is not available.
    """

    kind: str
    motion: str | None
    fits: Sequence[Fit]
    distances: np.ndarray
    numbers: Sequence[Mapping[str, float]]
    adapted: Callable[[int], np.ndarray] | None = None


def recommended(offer: Offer, best: Fit) -> NextTest | None:
    """The test on offer that separates most explanations; None where no two of them differ visibly."""
    pairs = list(combinations(offer.fits, 2))
    if not (offer.distances > UNSEEN).any():
        return None
    chosen, here = _confirmed(offer)
    separated = here >= SEPARATED if (here >= SEPARATED).any() else np.ones(len(pairs), bool)
    # Pairs with the best explanation are of most interest.
    with_best = separated & [one is best for one, _ in pairs]
    rows = np.flatnonzero(with_best if with_best.any() else separated)
    closest = int(rows[np.argmin(here[rows])])
    separations = tuple(
        Separation((_name(one), _name(other)), float(distance))
        for (one, other), distance in zip(pairs, here, strict=True)
    )
    numbers = offer.numbers[chosen]
    return NextTest(offer.kind, numbers, *separations[closest], separations, offer.motion)


def _confirmed(offer: Offer) -> tuple[int, np.ndarray]:
    """Index of the chosen test, and its distances (pairs,).

    If explanations turn out to adapt to the first choice, another test is chosen, up to TRIED times.
    """
    distances = offer.distances.copy()
    by_test = distances.reshape(len(distances), -1)
    for _ in range(TRIED):
        chosen = choice(distances)
        before = by_test[:, chosen].copy()
        if offer.adapted is None or not (before >= SEPARATED).any():
            break
        by_test[:, chosen] = np.minimum(before, offer.adapted(chosen))
        if ((by_test[:, chosen] >= SEPARATED) == (before >= SEPARATED)).all():
            break
    return chosen, by_test[:, chosen]


def choice(distances: np.ndarray) -> int:
    """The test (index in the flat grid) that separates most pairs, the cheapest of several.

    A test counts by the least that it and its neighbours in size separate: near breakaway predictions differ
    by any amount, and a fit to what is measured there has many minima. If none separates any pair, the one at
    which the closest pair lies farthest apart.

    Parameters
    ----------
    distances : ndarray, shape (pairs, A, B)
        Squared distances.
    """
    sure = minimum_filter1d(distances, 3, axis=1, mode="nearest")
    separated = (sure >= SEPARATED).sum(axis=0)
    least = np.where(separated == separated.max(), sure.min(axis=0), -1.0)
    if not separated.any():
        return int(np.argmax(least))
    row = int(np.argmax(separated.max(axis=1)))
    return row * distances.shape[2] + int(np.argmax(least[row]))


def covariance_root(fit: Fit) -> np.ndarray:
    """Root (k + u, k + u) of the covariance of a fit, in which no parameter is wider than its range."""
    std = np.sqrt(np.diag(fit.covariance))
    share = np.minimum(1.0, WIDEST * fit.model.scale / np.maximum(std, 1e-300))
    values, vectors = np.linalg.eigh(fit.covariance * np.outer(share, share))
    return vectors * np.sqrt(np.maximum(values, 0.0))


def least_distance(gap: np.ndarray, columns: np.ndarray) -> float:
    """Squared distance of two predictions when their parameters change so that it is least.

    The squared changes of parameters, in standard deviations, are part of it. ``gap`` (m,): whitened
    difference of the predictions; ``columns`` (m, j): its changes by a standard deviation of each parameter.
    """
    matrix = np.concatenate([columns, np.eye(columns.shape[1])])
    aim = np.concatenate([gap, np.zeros(columns.shape[1])])
    change = np.linalg.lstsq(matrix, aim, rcond=None)[0]
    return float(((aim - matrix @ change) ** 2).sum())


def _name(fit: Fit) -> str:
    return " + ".join(fit.effects) or "base"
