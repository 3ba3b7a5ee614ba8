"""tests.toml: the tests to make, and the uncertain numbers of their measured.toml."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import Any

from wedgesweep import rotation, toml
from wedgesweep.config.keys import Choice, Flag, Number
from wedgesweep.config.tables import TableList, table
from wedgesweep.config.turned import Turned
from wedgesweep.effects.thermal_drift import TEMPERATURE
from wedgesweep.errors import InputError
from wedgesweep.measured.declarations import (
    AMPLITUDE,
    AMPLITUDE_STD,
    FORCE_AMPLITUDE,
    FREQUENCY,
    KINDS,
    LOOP,
    STEADY,
    TRANSIENT,
    UNCERTAIN,
)
from wedgesweep.quantity import Quantity

MOTIONS = ("release", "sweep", "random", "bump")
KIND = Choice(
    "kind",
    "steady; transient (see motion); loop: force under a motion of frequency_hz and amplitude_mm",
    choices=KINDS,
    default=STEADY,
)
MOTION = Choice(
    "motion",
    "transient: release; sweep or random from frequency_hz to to_hz; bump of length 1/frequency_hz",
    choices=MOTIONS,
    default="release",
)
DURATION = Quantity("duration_s", 10.0, "transient, loop: length of the record", above=0.0)
TO = Quantity("to_hz", nan, "transient: highest frequency of a sweep or of random motion", above=0.0)
RELEASE = Quantity("release_mm", 0.0, "transient: displacement at the start")
THROWN = Quantity("release_mm_per_s", 0.0, "transient: velocity at the start")
KNOWN = Flag("known", "whether measured.toml states the amplitude", default=True)

ROOT = table(
    "",
    "tests to make",
    UNCERTAIN,
    TableList(
        "test",
        "the tests",
        item=table(
            "test",
            "one test",
            KIND,
            MOTION,
            Number.of(FREQUENCY, optional=True, example=20.0),
            Number.of(AMPLITUDE, optional=True, example=0.1),
            Number.of(FORCE_AMPLITUDE, optional=True, example=1.0),
            Number.of(AMPLITUDE_STD),
            Number.of(DURATION),
            Number.of(TO, optional=True),
            Number.of(RELEASE),
            Number.of(THROWN),
            Number.of(TEMPERATURE, default=None, optional=True, example=20.0),
            KNOWN,
        ),
    ),
)


@dataclass(frozen=True)
class PlannedTest:
    """One test with its nominal amplitude in ``unit``; ``amplitude_std`` is relative, 0 if not given.

    ``motion`` of a transient: a release, or the shape of its input, from ``frequency_hz`` to ``to_hz``.
    """

    frequency_hz: float
    amplitude: float
    unit: str
    amplitude_std: float
    known: bool
    kind: str = STEADY
    motion: str = "release"
    duration_s: float = 0.0
    to_hz: float | None = None
    release_mm: float = 0.0
    release_mm_per_s: float = 0.0
    temperature_C: float | None = None

    @property
    def driven(self) -> bool:
        """Whether it is a transient under an input."""
        return self.kind == TRANSIENT and self.motion != "release"


@dataclass(frozen=True)
class Plan:
    """The tests, the relative std of uncertain numbers by the effect that scales them, and their file."""

    tests: tuple[PlannedTest, ...]
    uncertain: dict[str, float]
    source: str = "tests"


def load(path: Path, turns: bool = False) -> Plan:
    """Read a tests.toml of one that ``turns`` or not; raises InputError with everything that is wrong."""
    return from_document(toml.load(path, "a tests.toml"), str(path), turns)


def from_document(given: Mapping[str, Any], source: str = "tests", turns: bool = False) -> Plan:
    """Check the tables of a tests.toml; raises InputError with everything that is wrong."""
    problems: list[str] = []
    turned = Turned()
    root, told = (turned.table(ROOT), rotation.text) if turns else (ROOT, str)
    document = turned.back(root.read(given, "", problems))
    for i, test in enumerate(document.get("test", ())):
        problems += [f"test[{i}].{told(fault)}" for fault in _faults(test)]
    if problems:
        raise InputError([f"{source}: {problem}" for problem in problems])
    return Plan(tuple(map(_planned, document["test"])), document["uncertain"], source)


def _faults(given: Mapping[str, Any]) -> list[str]:
    """Keys of a test that are missing or contradict each other, as "key: fault"."""
    stated = [key for key in (AMPLITUDE.key, FORCE_AMPLITUDE.key) if key in given]
    if given.get("kind") == TRANSIENT and given.get("motion") == "release":
        at_rest = given.get("release_mm") == given.get("release_mm_per_s") == 0.0
        return ["release_mm: 0, and so is release_mm_per_s; nothing would move"] if at_rest else []
    faults = [] if "frequency_hz" in given else ["frequency_hz: missing; write frequency_hz = 20.0"]
    if len(stated) != 1:
        faults.append(f"{AMPLITUDE.key}: write this, or {FORCE_AMPLITUDE.key}, and not both")
    if given.get("motion") in ("sweep", "random") and "to_hz" not in given:
        faults.append("to_hz: missing; write the highest frequency")
    if given.get("kind") == TRANSIENT and given.get("motion") == "random":
        faults += _band_faults(given)
    if given.get("kind") == LOOP and FORCE_AMPLITUDE.key in given:
        faults.append(f"{FORCE_AMPLITUDE.key}: a loop imposes a motion; write {AMPLITUDE.key}")
    return faults


def _band_faults(given: Mapping[str, Any]) -> list[str]:
    """Why random motion has no frequency within its band, as "key: fault"."""
    if not {"frequency_hz", "to_hz", "duration_s"} <= given.keys():
        return []
    low, high, duration = (given[key] for key in ("frequency_hz", "to_hz", "duration_s"))
    if high <= low:
        return [f"to_hz: {high:g} is not above frequency_hz = {low:g}; write an increasing band"]
    if (high - low) * duration <= 1.0:
        return [f"duration_s: {duration:g} s are too short for a band of {high - low:g} Hz; lengthen it"]
    return []


def _planned(given: Mapping[str, Any]) -> PlannedTest:
    unit = "N" if FORCE_AMPLITUDE.key in given else "mm"
    return PlannedTest(
        given.get("frequency_hz", 0.0),
        given.get(f"amplitude_{unit}", 0.0),
        unit,
        given["amplitude_std"],
        given["known"],
        given["kind"],
        given["motion"],
        given["duration_s"],
        given.get("to_hz"),
        given["release_mm"],
        given["release_mm_per_s"],
        given.get(TEMPERATURE.key),
    )
