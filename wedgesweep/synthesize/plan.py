"""tests.toml: the tests to make, and the uncertain numbers of their measured.toml."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wedgesweep.config import toml
from wedgesweep.config.keys import Flag, Number
from wedgesweep.config.tables import TableList, table
from wedgesweep.errors import InputError
from wedgesweep.files import read_text
from wedgesweep.measured.declarations import AMPLITUDE, AMPLITUDE_STD, FORCE_AMPLITUDE, FREQUENCY, UNCERTAIN

KNOWN = Flag(key="known", meaning="whether measured.toml states the amplitude", default=True)

ROOT = table(
    "",
    "tests to make",
    UNCERTAIN,
    TableList(
        key="test",
        meaning="the tests",
        item=table(
            "test",
            "one test",
            Number.of(FREQUENCY, example=20.0),
            (Number.of(AMPLITUDE, example=0.1), Number.of(FORCE_AMPLITUDE, example=1.0)),
            Number.of(AMPLITUDE_STD),
            KNOWN,
        ),
    ),
)


@dataclass(frozen=True)
class PlannedTest:
    """One test with its nominal amplitude in ``unit``; ``amplitude_std`` is relative, 0 if not given."""

    frequency_hz: float
    amplitude: float
    unit: str
    amplitude_std: float
    known: bool


@dataclass(frozen=True)
class Plan:
    """The tests, the relative std of uncertain numbers by the effect that scales them, and their file."""

    tests: tuple[PlannedTest, ...]
    uncertain: dict[str, float]
    source: str = "tests"


def load(path: Path) -> Plan:
    """Read a tests.toml; raises InputError with everything that is wrong."""
    try:
        given = toml.loads(read_text(path))
    except OSError as error:
        problem = f"{path}: {error.strerror}; give the path of a tests.toml"
        raise InputError([problem]) from error
    except ValueError as error:
        raise InputError([f"{path}: not valid TOML: {error}"]) from error
    problems: list[str] = []
    document = ROOT.read(given, "", problems)
    if problems:
        raise InputError([f"{path}: {problem}" for problem in problems])
    return Plan(tuple(map(_planned, document["test"])), document["uncertain"], str(path))


def _planned(given: Mapping[str, Any]) -> PlannedTest:
    unit = "N" if FORCE_AMPLITUDE.key in given else "mm"
    amplitude = given[f"amplitude_{unit}"]
    return PlannedTest(given["frequency_hz"], amplitude, unit, given["amplitude_std"], given["known"])
