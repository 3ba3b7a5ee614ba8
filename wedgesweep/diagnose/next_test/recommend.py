"""The next test: the cheapest one that separates explanations, like those that were made or of another kind.

The criterion is T-optimality (Atkinson and Fedorov, 1975, Biometrika 62, 57).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from scipy.ndimage import minimum_filter1d

from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.designs import Design, Offer, offered
from wedgesweep.diagnose.next_test.loops import loops
from wedgesweep.diagnose.next_test.sensors import Sensors
from wedgesweep.diagnose.next_test.steady import sines
from wedgesweep.diagnose.next_test.transients import releases, sweeps
from wedgesweep.diagnose.transient.transient_data import RELEASE, SWEEP
from wedgesweep.diagnose.work import SLIGHT
from wedgesweep.measured.declarations import LOOP, STEADY, TRANSIENT

# Squared distance at which two explanations are separated; up to SLIGHT they do not differ visibly.
SEPARATED = 30.0
# Tests that are looked at closely, if explanations adapt to those before.
TRIED = 5
# Tests to choose from by the best fit, its sensors and the measured tests of that kind, with their kind; what
# a laboratory has first.
DESIGNS: dict[str, tuple[str, Callable[[Fit, Sensors, Any], Design | None]]] = {
    STEADY: (STEADY, sines),
    RELEASE: (TRANSIENT, releases),
    SWEEP: (TRANSIENT, sweeps),
    LOOP: (LOOP, loops),
}


class Separation(NamedTuple):
    """Two explanations by name, the better one first, and the squared distance of their predictions."""

    names: tuple[str, str]
    distance: float

    @property
    def separated(self) -> bool:
        return self.distance >= SEPARATED


@dataclass(frozen=True)
class NextTest:
    """A test to make.

    ``kind`` of test, for a transient with its ``motion``; ``numbers`` by the keys and in the units of
    diagnosis.json; ``pairs``: how far apart every two of the compared explanations are, the best one's first.
    """

    kind: str
    motion: str | None
    numbers: Mapping[str, float]
    pairs: tuple[Separation, ...]

    @property
    def separated(self) -> list[Separation]:
        """The pairs that it separates."""
        return [each for each in self.pairs if each.separated]

    @property
    def from_best(self) -> list[Separation]:
        """The pairs with the best explanation that it separates."""
        return [each for each in self.separated if self.pairs[0].names[0] in each.names]

    @property
    def closest(self) -> Separation:
        """The closest pair that it separates, one with the best explanation if there is any."""
        found = self.from_best or self.separated or self.pairs
        return min(found, key=lambda each: each.distance)

    @property
    def worth(self) -> tuple[int, float]:
        """How many pairs it separates; if none, how far apart the closest one is."""
        return len(self.separated), 0.0 if self.separated else self.closest.distance


def recommend(fits: Sequence[Fit]) -> NextTest | None:
    """The test that separates most fits, the best one first; None if there is nothing to separate.

    Tests of the kinds that were made come first: the rig can do them. Others are looked at where those do not
    separate the best fit from any other.
    """
    if len(fits) < 2:
        return None
    parts = fits[0].model.data.parts
    made = [name for part in parts for name in part.offers]
    found = [_like(name, fits, parts) for name in made]
    if not any(test and test.from_best for test in found):
        found += [_like(name, fits, parts) for name in DESIGNS if name not in made]
    # Of equals the first one.
    return max(filter(None, found), key=lambda test: test.worth, default=None)


def _like(name: str, fits: Sequence[Fit], parts: Sequence[FitData]) -> NextTest | None:
    """The next test of one kind; motions may be as large as in any of the measured tests."""
    (kind, design), measured = DESIGNS[name], {part.kind: part for part in parts}
    known = {kind: sensors for kind, part in measured.items() if (sensors := part.sensors()) is not None}
    if not known:
        return None
    own = known.get(kind, next(iter(known.values())))
    own = own._replace(travel=max(each.travel for each in known.values()))
    tests = design(fits[0], own, measured.get(kind))
    return None if tests is None else recommended(tests, fits)


def recommended(design: Design, fits: Sequence[Fit]) -> NextTest | None:
    """The test of a design that separates most fits, the best one first; None where none differ visibly."""
    offer = offered(design, fits)
    if not (offer.distances > SLIGHT).any():
        return None
    chosen, distances = _confirmed(offer)
    names = combinations([" + ".join(fit.effects) or "base" for fit in offer.fits], 2)
    pairs = tuple(Separation(*each) for each in zip(names, distances.tolist(), strict=True))
    return NextTest(design.kind, design.motion, design.numbers[chosen], pairs)


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
