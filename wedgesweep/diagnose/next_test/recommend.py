"""The next test over all kinds: one like those that were made, or of another kind where they tell nothing."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.designs import Design
from wedgesweep.diagnose.next_test.loops import loops
from wedgesweep.diagnose.next_test.offer import SEPARATED, NextTest, recommended
from wedgesweep.diagnose.next_test.sensors import Sensors
from wedgesweep.diagnose.next_test.steady import sines
from wedgesweep.diagnose.next_test.transients import releases, sweeps
from wedgesweep.diagnose.transient.transient_data import RELEASE, SWEEP
from wedgesweep.measured.declarations import LOOP, STEADY, TRANSIENT


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
    if not any(map(_decides, found)):
        found += [_like(name, fits, parts) for name in DESIGNS if name not in made]
    possible = [each for each in found if each is not None]
    # Of equals the first one.
    return max(possible, key=_worth, default=None)


def _decides(test: NextTest | None) -> bool:
    """Whether a test separates the best fit from another."""
    if test is None:
        return False
    first = test.pairs[0].names[0]
    return any(first in each.names and each.distance >= SEPARATED for each in test.pairs)


def _worth(test: NextTest) -> tuple[int, float]:
    """How many pairs a test separates; if it separates none, how far apart the closest one is."""
    separated = sum(each.distance >= SEPARATED for each in test.pairs)
    return separated, 0.0 if separated else min(each.distance for each in test.pairs)


def _like(name: str, fits: Sequence[Fit], parts: Sequence[FitData]) -> NextTest | None:
    """The next test of one kind; motions may be as large as in any of the measured tests."""
    wanted, measured = DESIGNS[name], {part.kind: part for part in parts}
    known = {kind: sensors for kind, part in measured.items() if (sensors := part.sensors()) is not None}
    if not known:
        return None
    own = known.get(wanted.kind, next(iter(known.values())))
    own = own._replace(travel=max(each.travel for each in known.values()))
    design = wanted.design(fits[0], own, measured.get(wanted.kind))
    return None if design is None else recommended(design, fits)


class _Kind(NamedTuple):
    """The kind of record of a next test, and its design by the best fit, its sensors and measured tests."""

    kind: str
    design: Callable[[Fit, Sensors, Any], Design | None]


# Tests to choose from, what a laboratory has first.
DESIGNS = {
    STEADY: _Kind(STEADY, sines),
    RELEASE: _Kind(TRANSIENT, lambda best, known, measured: releases(best, known)),
    SWEEP: _Kind(TRANSIENT, lambda best, known, measured: sweeps(best, known)),
    LOOP: _Kind(LOOP, loops),
}
