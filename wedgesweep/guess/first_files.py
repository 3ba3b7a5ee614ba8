"""Writes a first measured.toml and its model for the files of a measurement."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from wedgesweep import measured
from wedgesweep.errors import InputError
from wedgesweep.files import write_text
from wedgesweep.guess import document
from wedgesweep.guess.columns import INPUT, is_relative
from wedgesweep.guess.model import Numbers, against_input, negated, numbers
from wedgesweep.guess.tests import Guessed, imposed, tests_of
from wedgesweep.measured import Measurement, consistency
from wedgesweep.measured.declarations import LOOP
from wedgesweep.measured.kinds import FEWEST
from wedgesweep.readers import ReadError
from wedgesweep.readers.survey import survey
from wedgesweep.units import angular

MODEL = "model.toml"
# Times that a file is written: as it is, as loops, with the signs of channels, and with the numbers of these.
MOST_LOOKS = 4
UNKNOWN = Numbers(1.0, 1e3, 0.0, unseen=("mass", "damping"))


@np.errstate(all="ignore")  # numbers in the files may be of any size
def write(path: Path, files: Sequence[Path]) -> list[Path]:
    """Write a measured.toml at a path and a model beside it; return both.

    Raises InputError for files that hold no numbers.
    """
    problems: list[str] = []
    surveys = []
    for file in files:
        try:
            surveys.append(survey(file))
        except ReadError as error:
            problems += error.problems
    records = [each for each in surveys if each.samples >= FEWEST] or [
        each for each in surveys if each.columns
    ]
    if not records:
        problems += [f"{each.path}: no columns of numbers in it; export it as CSV" for each in surveys]
    if problems:
        raise InputError(problems)
    left = [each.path for each in surveys if each not in records]
    tests, model, found = tests_of(records), path.parent / MODEL, UNKNOWN
    channels = tests[0].run.channels
    relative = named = frozenset(name for name, each in channels.items() if is_relative(each.column))
    turns = any(angular(each.unit) for each in channels.values())
    for _ in range(MOST_LOOKS):
        write_text(path, document.measured(path, model, tests, surveys, found, relative, left))
        write_text(model, document.model(found, _is_forced(tests[0]), turns))
        try:
            measurement = measured.read(path)
        except InputError:
            break
        before = tests, found, relative
        relative = against_input(measurement) | named
        tests, found = _with_signs(tests, measurement), numbers(measurement)
        if "mass" in found.unseen:
            tests = [imposed(test) for test in tests]
        if (tests, found, relative) == before:
            break
    return [path, model]


def write_model(path: Path, data: Path) -> None:
    """Write a model with the numbers that the records of a measured.toml show; raises InputError."""
    measurement = _read(data)
    found, model = numbers(measurement), measurement.model
    write_text(path, document.model(found, model.forced, model.turns))


def _read(data: Path) -> Measurement:
    """A measurement under its model or, if its units have become those of a rotation, one that turns."""
    try:
        return measured.read(data)
    except InputError:
        with TemporaryDirectory() as folder:
            turning = Path(folder) / MODEL
            for forced in (True, False):
                turning.write_text(document.model(UNKNOWN, forced, turns=True))
                with suppress(InputError):
                    return measured.read(data, turning)
        raise


def _with_signs(tests: Sequence[Guessed], measurement: Measurement) -> list[Guessed]:
    """Tests whose force has the sign at which a passive system explains it."""
    turned = {test.name for test in [*consistency.negated(measurement), *negated(measurement)]}
    return [
        replace(test, negated="force" if test.kind == LOOP else INPUT) if record.name in turned else test
        for test, record in zip(tests, measurement.tests, strict=True)
    ]


def _is_forced(test: Guessed) -> bool:
    given = test.run.channels.get(INPUT)
    return test.kind == LOOP or (given is not None and given.keys.get("quantity") == "force")
