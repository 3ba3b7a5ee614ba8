"""Choice of a next test: the cheapest of the tests of one kind that separates explanations.

The criterion is T-optimality (Atkinson and Fedorov, 1975, Biometrika 62, 57).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np
from scipy.ndimage import minimum_filter1d

from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.designs import Design, Offer, offered

# Squared distance at which two explanations are separated, and below which they do not differ visibly.
SEPARATED, UNSEEN = 30.0, 1.0
# Tests that are looked at closely, if explanations adapt to those before.
TRIED = 5


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


def recommended(design: Design, fits: Sequence[Fit]) -> NextTest | None:
    """The test of a design that separates most fits, the best one first; None where none differ visibly."""
    offer = offered(design, fits)
    if not (offer.distances > UNSEEN).any():
        return None
    chosen, here = _confirmed(offer)
    pairs = list(combinations(offer.fits, 2))
    separated = here >= SEPARATED if (here >= SEPARATED).any() else np.ones(len(pairs), bool)
    # Pairs with the best explanation are of most interest.
    with_best = separated & [one is fits[0] for one, _ in pairs]
    rows = np.flatnonzero(with_best if with_best.any() else separated)
    closest = int(rows[np.argmin(here[rows])])
    separations = tuple(
        Separation((_name(one), _name(other)), float(distance))
        for (one, other), distance in zip(pairs, here, strict=True)
    )
    return NextTest(
        design.kind, design.numbers[chosen], *separations[closest], separations, motion=design.motion
    )


def _confirmed(offer: Offer) -> tuple[int, np.ndarray]:
    """Index of the chosen test, and its distances (pairs,).

    If explanations turn out to adapt to the first choice, another test is chosen, up to TRIED times.
    """
    distances = offer.distances.copy()
    by_test = distances.reshape(len(distances), -1)
    for _ in range(TRIED):
        chosen = choice(distances)
        before = by_test[:, chosen].copy()
        if not (before >= SEPARATED).any():
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


def _name(fit: Fit) -> str:
    return " + ".join(fit.effects) or "base"
