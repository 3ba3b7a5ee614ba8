"""All that a file holds: every column of numbers, under a name by which it is read, and single numbers."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep import readers
from wedgesweep.files import read_bytes, regular
from wedgesweep.readers import dialect as csv_dialect
from wedgesweep.readers import text
from wedgesweep.readers.dialect import Dialect, bare
from wedgesweep.readers.table import Channel, Name, ReadError, Wanted, channel_of, matrix_of
from wedgesweep.units import UNITS, is_unit

Stated = Mapping[str, str]

# Rows of a text file that are looked at, and the share of them that holds numbers in a column of numbers.
ROWS, NUMBERS = 500, 0.8
# Rows of a table that is no list of remarks.
FEWEST_ROWS = 8
# Columns of a matrix that may be channels.
WIDEST = 64
# Group and name of a variable in it: group/name, Sheet!name, structure.name; not the unit m/s in brackets.
GROUP = re.compile(r"([^\[(]*)[/!.]([^/!.].*)", re.DOTALL)
# What belongs to one of an array of structures.
OF_AN_ARRAY = re.compile(r"(.*\(\d+\))\.(.*)")
SAMPLES = re.compile(r"data|daten|values?|samples", re.IGNORECASE)
# Cells of a header of words between spaces: a unit in brackets belongs to the word before it.
WORDS = re.compile(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?")
# A line that names a number, with its unit before or behind it; its greatest length; and factors of units.
PLAIN = re.compile(r"[+-]?\d+\.?\d*(?:[eE][+-]?\d+)?")
NAMED_NUMBER = re.compile(
    r"\W*(?P<name>[A-Za-z][\w .]*?)\s*(?:[\[(](?P<before>[^\])]*)[\])])?\s*[:=,;\t]+\s*"
    rf"(?P<number>{PLAIN.pattern})\s*[\[(]?(?P<behind>[A-Za-z]*)[\])]?[\s,;]*"
)
LONGEST, FACTORS = 200, {"kHz": 1e3, **UNITS["time"]}


@dataclass(frozen=True, eq=False)
class Column:
    """A channel as a file holds it.

    ``words``: the cells above it, from the top; ``group``: where it is; ``missing``: texts that stand for a
    missing sample; ``rate`` (Hz) and ``start`` (s): of a clock of its own beside that of the others, or 0.
    """

    name: Name
    words: tuple[str, ...]
    channel: Channel
    group: str = ""
    missing: tuple[str, ...] = ()
    rate: float = 0.0
    start: float = 0.0

    @property
    def label(self) -> str:
        return " ".join(self.words)


@dataclass(frozen=True, eq=False)
class Survey:
    """Columns of a file in their order, its single numbers by name, and the dialect that must be stated."""

    path: Path
    columns: tuple[Column, ...]
    numbers: Mapping[str, float] = field(default_factory=dict)
    stated: Mapping[str, str] = field(default_factory=dict)

    @property
    def samples(self) -> int:
        """Those of the longest column."""
        return max((each.channel.values.size for each in self.columns), default=0)


def survey(path: Path) -> Survey:
    """Look at all columns of a file, which may have none of numbers; raises ReadError."""
    reader = readers.READERS.get(path.suffix.lower())
    if reader is None:
        return _of_text(path)
    stored = readers.stored(path, lambda: reader(regular(path), Wanted()))
    columns: list[Column] = []
    numbers: dict[str, float] = {}
    seen: set[int] = set()
    for name, raw in stored.items():
        if raw is None or id(raw) in seen:
            continue
        seen.add(id(raw))
        values = np.asarray(raw.values)
        if values.size == 1 and values.dtype.kind in "fiu":
            numbers[name] = float(values.ravel()[0])
        columns += _variables(name, raw)
    return Survey(path, tuple(columns), numbers)


def _variables(name: str, raw: Channel) -> list[Column]:
    """A variable as a column, or the columns of a matrix."""
    values = matrix_of(np.asarray(raw.values))
    matrix = values.ndim == 2 and 1 < values.shape[1] <= min(WIDEST, values.shape[0])
    parts: list[tuple[str, Any]] = [(name, raw.values)]
    if matrix:
        parts = [(f"{name}[{number}]", column) for number, column in enumerate(values.T, 1)]
    found = []
    for part, samples in parts:
        try:
            channel = channel_of(samples, raw.unit, raw.clock)
        except ValueError:
            continue
        if channel.values.size >= FEWEST_ROWS:
            group, inner = _within(part)
            found.append(Column(part, (inner, *filter(None, [raw.label])), channel, group))
    return found


def _within(name: str) -> tuple[str, str]:
    """Group, sheet or structure of a variable, and its name there: of its samples that of what holds them."""
    found = OF_AN_ARRAY.fullmatch(name) or GROUP.fullmatch(name)
    if not found:
        return "", name
    inside = SAMPLES.fullmatch(found[2]) and GROUP.fullmatch(found[1])
    return (inside[1], inside[2]) if inside else (found[1], found[2])


def _of_text(path: Path) -> Survey:
    """Columns of a text file by their numbers in the widest table that some separator makes of it."""
    try:
        content, encoding = csv_dialect.decode(read_bytes(path), None)
    except OSError as error:
        raise ReadError([f"{path}: {error.strerror}; give the path of a data file"]) from error
    except ValueError as error:
        raise ReadError([f"{path}: {error}"]) from error
    lines = csv_dialect.LINE_END.split(content)
    tables = {name: _numbers(lines, sign) for name, sign in csv_dialect.DELIMITERS.items()}
    delimiter = max(tables, key=lambda name: (tables[name][1], name != "space"))
    numbers = tables[delimiter][0]
    if not numbers:
        return Survey(path, ())
    faults: list[str] = []
    for decimal in ({}, {"decimal": "comma"}, {"decimal": "point"}):
        try:
            how = csv_dialect.detect(lines, encoding, numbers, {"delimiter": delimiter, **decimal})
            if how is None:
                faults.append("no row from which on its columns hold numbers; export it as CSV")
                continue
            stated = {**decimal, **_delimiter(lines, encoding, numbers, how, decimal)}
            table = text.read(path, numbers, stated)
        except (ReadError, ValueError) as error:
            faults.append(str(error))
            continue
        labels = _labels(lines[: how.first], how.delimiter, how.width, numbers)
        names = _names(lines, encoding, labels, how, stated)
        columns = (
            Column(name, labels[number], table.channels[number])
            for number, name in zip(numbers, names, strict=True)
        )
        return Survey(path, tuple(columns), _single_numbers(lines, how, numbers), stated)
    raise ReadError([faults[0] if faults[0].startswith(str(path)) else f"{path}: {faults[0]}"])


def _delimiter(
    lines: Sequence[str], encoding: str, numbers: Sequence[int], how: Dialect, decimal: Stated
) -> dict[str, str]:
    """The separator, where the file would be read in another way without it."""
    try:
        if csv_dialect.detect(lines, encoding, numbers, decimal) == how:
            return {}
    except ValueError:
        pass
    return {"delimiter": next(name for name, sign in csv_dialect.DELIMITERS.items() if sign == how.delimiter)}


def _numbers(lines: Sequence[str], delimiter: str) -> tuple[list[int], int]:
    """Columns of numbers, from 1, that a separator makes of lines; and how many more they are than others."""
    filled = [line for line in lines[: 2 * ROWS] if not csv_dialect.is_skipped(line)][:ROWS]
    rows = [csv_dialect.split(line, delimiter) for line in filled]
    # Text above the numbers is none of them.
    data = rows[next((i for i, row in enumerate(rows) if _is_data(row)), len(rows)) :]
    if len(data) < FEWEST_ROWS:
        return [], 0
    found, others = [], 0
    for place in range(max(map(len, data))):
        cells = [row[place] for row in data if place < len(row) and row[place] not in csv_dialect.MISSING]
        if not cells:
            continue
        good = len(cells) > 2 and sum(map(csv_dialect.is_number, cells)) >= NUMBERS * len(cells)
        found += [place + 1] if good else []
        others += not good
    return found, len(found) - others


def _is_data(row: Sequence[str]) -> bool:
    cells = [cell for cell in row if cell not in csv_dialect.MISSING]
    return len(cells) > 0 and 2 * sum(map(csv_dialect.is_number, cells)) > len(cells)


def _single_numbers(lines: Sequence[str], how: Dialect, columns: Sequence[int]) -> dict[str, float]:
    """Numbers by name: in lines above the columns, or once below a name where the columns begin."""
    found = {}
    for line in lines[: how.first]:
        if len(line) <= LONGEST and (pair := NAMED_NUMBER.fullmatch(line)):
            unit = pair["before"] or pair["behind"]
            found[pair["name"]] = float(pair["number"]) * FACTORS.get(unit, 1.0)
    rows = [csv_dialect.split(line, how.delimiter) for line in lines[max(how.first - 1, 0) : how.first + 1]]
    others = [number for number in range(1, max(map(len, rows)) + 1) if number not in columns]
    for number, words in _labels(lines[: how.first], how.delimiter, how.width, others).items():
        cells = [row[number - 1] for row in rows if number <= len(row) and PLAIN.fullmatch(row[number - 1])]
        if words and cells:
            found[words[-1]] = float(cells[0])
    return found


def _labels(
    above: Sequence[str], delimiter: str, width: int, numbers: Sequence[int]
) -> dict[int, tuple[str, ...]]:
    """Cells above each column of numbers, from the top; lines with few cells are no header, and end it."""
    found: dict[int, tuple[str, ...]] = dict.fromkeys(numbers, ())
    for line in reversed(above):
        plain = line.lstrip().lstrip("".join(csv_dialect.COMMENTS)).strip()
        row = csv_dialect.split(plain, delimiter)
        if delimiter == " " and len(row) > width:
            row = WORDS.findall(plain)
        if not width // 2 < len(row) <= width + 1:
            if plain and any(found.values()):
                break
            continue
        for number in numbers:
            cell = row[number - 1] if number <= len(row) else ""
            if cell and not csv_dialect.is_number(cell):
                found[number] = (cell, *found[number])
    return found


def _names(
    lines: Sequence[str], encoding: str, labels: Mapping[int, Sequence[str]], how: Dialect, stated: Stated
) -> list[Name]:
    """Names of columns: words above them that lead to the same column, else their numbers."""

    def leads(names: Sequence[Name], places: Sequence[int]) -> bool:
        try:
            found = csv_dialect.detect(lines, encoding, names, stated)
        except ValueError:
            return False
        return found is not None and list(found.places) == [*places] and found.first == how.first

    names: list[Name] = []
    for number, words in labels.items():
        named = [each for each in words if not is_unit(bare(each))] or words
        names.append(next((each for each in reversed(named) if leads([each], [number - 1])), number))
    return names if leads(names, [number - 1 for number in labels]) else list(labels)
