"""Text of a first measured.toml and of its model: what was guessed, and questions as comments."""

import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from wedgesweep import rotation, toml
from wedgesweep.guess.columns import INPUT, Chosen, mean_load
from wedgesweep.guess.model import Numbers
from wedgesweep.guess.tests import UNKNOWN_RATE, Guessed
from wedgesweep.measured import contact_load
from wedgesweep.measured.declarations import ABSOLUTE, LOOP, RELATIVE, STEADY
from wedgesweep.readers.survey import Survey

# Marks a line that asks.
ASK = "# ? "
# Columns that are listed, and their relative std where numbers of the model come from the record.
LISTED, GUESSED = 24, 0.1
ORDER = ("displacement", "velocity", "acceleration", "force", INPUT)


def measured(
    path: Path,
    model: Path,
    tests: Sequence[Guessed],
    surveys: Sequence[Survey],
    found: Numbers,
    relative: Collection[str],
    left: Sequence[Path],
) -> str:
    """Text of a measured.toml at a path.

    ``relative``: channels of motion against the input; ``left``: files that are no records.
    """
    first = tests[0]
    lines = [
        "# Written by wedgesweep init after a look at the data. Lines with '# ?' ask what it could not know.",
        "",
        "[measurement]",
        f"title = {toml.inline(path.absolute().parent.name or 'measurement')}",
        f"model = {toml.inline(_relative(model, path))}",
        f"kind = {toml.inline(first.kind)}  # {first.reason}",
        *_rate(first),
        "",
        "[measurement.columns]",
        *_columns(first, path, relative),
        *_dialect(surveys),
        *_uncertain(found),
    ]
    for test in tests:
        lines += ["", *_test(test, first, path)]
    if left:
        names = ", ".join(_relative(each, path) for each in left)
        lines += ["", f"{ASK}left out, as they have too few numbers for records: {names}. Are they?"]
    return "\n".join(lines) + "\n"


def _relative(file: Path, path: Path) -> str:
    return Path(os.path.relpath(file, path.parent)).as_posix()


def _rate(first: Guessed) -> Iterator[str]:
    """The sampling rate where no column holds the time."""
    if first.run.time is not None or any(
        each.column.channel.clock is not None for each in first.run.channels.values()
    ):
        return
    if first.rate is None:
        yield f"{ASK}No column looks like time: how many samples are there in a second?"
        if first.kind == LOOP:
            yield f"{ASK}At another rate friction and springs stay as they are; damping and mass do not."
        yield f"{'' if first.kind == LOOP else '# '}rate_hz = {UNKNOWN_RATE}"
    else:
        yield f"rate_hz = {first.rate:.10g}  # as a number in the file says, or its velocity"


def _columns(first: Guessed, path: Path, relative: Collection[str]) -> Iterator[str]:
    """Lines of the channels, and a list of the other columns."""
    if first.run.time is not None:
        yield from _channel("time", first.run.time, path)
    channels = first.run.channels
    moved_base = INPUT in channels and channels[INPUT].keys.get("quantity") != "force"
    for name in ORDER:
        if name not in channels:
            continue
        more: dict[str, Any] = {}
        if moved_base and name != INPUT:
            more["of"] = RELATIVE if name in relative else ABSOLUTE
            yield f'{ASK}of: against the ground ("absolute"), or against what is the input ("relative")?'
        yield from _channel(name, channels[name], path, more)
    if not channels:
        yield f"{ASK}which column is the motion, and what is its unit?"
        yield '# displacement = { column = "?", unit = "mm" }'
    left = [toml.inline(each.name) + _words(each.name, each.label) for each in first.run.left]
    if left:
        more_left = f", and {len(left) - LISTED} more" if len(left) > LISTED else ""
        yield f"# not used: {', '.join(left[:LISTED])}{more_left}"


def _words(name: object, label: str) -> str:
    return f" ({label})" if label and label != name else ""


def _channel(name: str, chosen: Chosen, path: Path, more: Mapping[str, Any] | None = None) -> Iterator[str]:
    for question in chosen.questions:
        yield f"{ASK}{question}"
    yield f"{name} = {toml.inline({**_keys(chosen, path), **(more or {})})}"


def _keys(chosen: Chosen, path: Path) -> dict[str, Any]:
    """All keys of a channel, with paths from a measured.toml."""
    keys = {"column": chosen.column.name, "unit": chosen.unit, **chosen.keys}
    return {key: _relative(value, path) if isinstance(value, Path) else value for key, value in keys.items()}


def _dialect(surveys: Sequence[Survey]) -> Iterator[str]:
    """What must be stated of how the files are written."""
    stated = {key: value for survey in reversed(surveys) for key, value in survey.stated.items()}
    if stated:
        yield from (
            "",
            "[measurement.csv]",
            *(f"{key} = {toml.inline(value)}" for key, value in stated.items()),
        )


def _uncertain(found: Numbers) -> Iterator[str]:
    """Numbers of the model that come from the records."""
    guessed = {
        "bolster_stiffness": found.spring > 0.0,
        "bolster_mass": not found.unseen,
        "friction_level": found.load > 0.0,
        "damping_level": found.damping > 0.0 and "damping" not in found.unseen,
    }
    if any(guessed.values()):
        yield from ("", "# These numbers of the model are guesses so far; leave out what you know better.")
        yield from ("[measurement.uncertain]", *(f"{name} = {GUESSED}" for name in guessed if guessed[name]))


def _test(test: Guessed, first: Guessed, path: Path) -> Iterator[str]:
    """Lines of a test; what differs from the first one is stated here."""
    yield "[[measurement.test]]"
    yield f"file = {toml.inline(_relative(test.file, path))}"
    if test.kind != first.kind:
        yield f"kind = {toml.inline(test.kind)}  # {test.reason}"
    if test.part.start is not None:
        yield f"from_s = {test.part.start!r}"
    if test.part.end is not None:
        yield f"to_s = {test.part.end!r}"
    if test.run.load is not None:
        load = float(f"{mean_load(test.run.load):.4g}")
        yield f"model = {toml.inline({contact_load.KEY: load})}  # mean load of the record"
    if test.kind == STEADY and INPUT not in test.run.channels:
        yield f"{ASK}how large is the motion of the base (amplitude_mm or _rad) or the force (amplitude_N)?"
        yield "# amplitude_mm = 1.0"
    own, others = _with_time(test), _with_time(first)
    for name in [name for name in others if name in own]:
        theirs = _keys(others[name], path)
        for key, value in _keys(own[name], path).items():
            if value != theirs.get(key):
                yield f"columns.{name}.{key} = {toml.inline(value)}"
    if test.negated:
        yield f"columns.{test.negated}.sign = -1  # as recorded it gives out energy, as no passive rig does"
    for name in [name for name in others if name not in own]:
        yield f"{ASK}no column of this file looks like {name}"


def _with_time(test: Guessed) -> dict[str, Chosen]:
    return {**({"time": test.run.time} if test.run.time else {}), **test.run.channels}


def model(found: Numbers, forced: bool, turns: bool) -> str:
    """Text of a config: a mass on a spring, or what turns on one."""
    unknown = "no record shows it: state what you know"
    if not forced:
        unknown += ", and multiply spring, damper and friction by it"
    notes = {
        "mass": unknown if "mass" in found.unseen else "by the record",
        "damping": "the diagnosis tells what damps it" if "damping" in found.unseen else "by the record",
    }
    size = f"{found.friction:.3g} {'N m' if turns else 'N'}"
    friction = "no friction, so that the diagnosis looks for it"
    friction += f"; the record shows about {size}" if found.friction else ""
    if found.load:
        friction = "each test has its own"
    coefficient = f"{found.friction:.3g}  # by the record"
    law = ("[friction]", f"dynamic = {coefficient}", f"static = {coefficient}", "") if found.load else ()

    def number(key: str, value: float) -> str:
        name, factor = rotation.turned_key(key) if turns else (key, 1.0)
        return f"{name} = {factor * value:.4g}"

    return "\n".join(
        (
            "# The model on trial. Replace guesses by what you know of the rig.",
            'title = "first model"',
            "",
            "[oscillator]",
            *(['motion = "rotation"  # channels are angles and torques'] if turns else []),
            f"{number('mass_kg', found.mass)}  # {notes['mass']}",
            f"{number('spring_N_per_mm', 1e-3 * found.spring)}  # by the record",
            *(
                ['restoring_force = "pendulum"  # a sine explains the records better than a spring']
                if found.swings
                else []
            ),
            f"{number('damping_N_s_per_m', found.damping)}  # {notes['damping']}",
            f"{number('normal_force_N', found.load)}  # {friction}",
            f'contact = "{"ground" if forced else "base"}"',
            "",
            *law,
            "[sweep]  # of no matter for a diagnosis, except for excitation",
            'friction_law = "coulomb"',
            f'excitation = "{"force" if forced else "base"}"',
            "frequency_hz = 1.0",
            number("amplitude_N" if forced else "amplitude_mm", 1.0),
            "",
        )
    )
