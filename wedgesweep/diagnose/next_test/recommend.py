"""The next test over all kinds: one like those that were made, or of another kind where they tell nothing."""

from collections.abc import Callable, Sequence

from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.loop.loop_data import LoopData
from wedgesweep.diagnose.mixed.mixed_data import MixedData
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.designs import Design
from wedgesweep.diagnose.next_test.loops import loops
from wedgesweep.diagnose.next_test.offer import SEPARATED, NextTest, recommended
from wedgesweep.diagnose.next_test.sensors import Sensors, sensors
from wedgesweep.diagnose.next_test.steady import sines
from wedgesweep.diagnose.next_test.transients import RELEASE, SWEEP, releases, sweeps
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.transient.transient_data import TransientData
from wedgesweep.measured.declarations import LOOP, STEADY

# Tests to choose from, what a laboratory has first.
ALL = (STEADY, RELEASE, SWEEP, LOOP)


def recommend(fits: Sequence[Fit]) -> NextTest | None:
    """The test that separates most fits, the best one first; None if there is nothing to separate.

    Tests of the kinds that were made come first: the rig can do them. Others are looked at where those do not
    separate the best fit from any other.
    """
    if len(fits) < 2:
        return None
    parts = _parts(fits[0].model.data)
    made = [kind for part in parts for kind in _made(part)]
    found = [_of_kind(kind, fits, parts) for kind in made]
    if not any(map(_decides, found)):
        found += [_of_kind(kind, fits, parts) for kind in ALL if kind not in made]
    possible = [each for each in found if each is not None]
    # Of equals the first one.
    return max(possible, key=_worth, default=None)


def _parts(data: FitData) -> list[FitData]:
    return data.present if isinstance(data, MixedData) else [data]


def _made(part: FitData) -> list[str]:
    """Kinds of test that were made."""
    if isinstance(part, TransientData):
        driven = {each.driven for each in part.windows}
        return [name for name, one in ((RELEASE, False), (SWEEP, True)) if one in driven]
    return [part.kind]


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


def _of_kind(kind: str, fits: Sequence[Fit], parts: Sequence[FitData]) -> NextTest | None:
    design = DESIGNS[kind](fits, parts)
    return None if design is None else recommended(design, fits)


def _steady(fits: Sequence[Fit], parts: Sequence[FitData]) -> Design:
    measured = next((part for part in parts if isinstance(part, HarmonicData)), None)
    return sines(fits[0], _known(parts, HarmonicData), measured)


def _release(fits: Sequence[Fit], parts: Sequence[FitData]) -> Design | None:
    known = _known(parts, TransientData)
    # Without a spring the mass stays where it is.
    if known.model.system == "oscillator" and known.model.oscillator["spring"] == 0.0:
        return None
    return releases(fits[0], known)


def _sweep(fits: Sequence[Fit], parts: Sequence[FitData]) -> Design | None:
    return sweeps(fits[0], _known(parts, TransientData))


def _loop(fits: Sequence[Fit], parts: Sequence[FitData]) -> Design | None:
    measured = next((part for part in parts if isinstance(part, LoopData)), None)
    return loops(fits[0], _known(parts, LoopData), measured)


def _known(parts: Sequence[FitData], kind: type[FitData]) -> Sensors:
    """The sensors of the tests of a kind, or of others if there are none; motions may be as large as any."""
    found = [sensors(part) for part in parts]
    own = next((each for each, part in zip(found, parts, strict=True) if isinstance(part, kind)), found[0])
    return own._replace(travel=max(each.travel for each in found))


DESIGNS: dict[str, Callable[[Sequence[Fit], Sequence[FitData]], Design | None]] = {
    STEADY: _steady,
    RELEASE: _release,
    SWEEP: _sweep,
    LOOP: _loop,
}
