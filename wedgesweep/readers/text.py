"""Numbers of the columns of a CSV or text file; faults name their line."""

from collections.abc import Mapping, Sequence
from math import isinf
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep.files import read_bytes
from wedgesweep.formatting import counted
from wedgesweep.hints import hint, show
from wedgesweep.readers import dialect as csv_dialect
from wedgesweep.readers.dialect import Dialect
from wedgesweep.readers.table import DATE, DATETIME, Channel, Name, ReadError, Table, seconds_of_dates


def read(path: Path, names: Sequence[Name], stated: Mapping[str, Any] | None = None) -> Table:
    """Read columns by their names or numbers.

    ``stated`` is the table measurement.csv, and ``missing`` further texts of missing samples. Raises
    ReadError.
    """
    stated = stated or {}
    try:
        text, encoding = csv_dialect.decode(read_bytes(path), stated.get("encoding"))
        lines = csv_dialect.LINE_END.split(text)
        dialect = csv_dialect.detect(lines, encoding, names, stated)
    except OSError as error:
        raise ReadError([f"{path}: {error.strerror}; give the path of a CSV file"]) from error
    except ValueError as error:
        raise ReadError([f"{path}: {error}"]) from error
    if dialect is None:
        raise ReadError([f"{path}:{fault}" for fault in _header_faults(lines, names, stated)])
    repeated = _further_headers(lines, dialect)
    filled = [
        line
        for line in range(dialect.first, len(lines))
        if line not in repeated and not csv_dialect.is_skipped(lines[line])
    ]
    missing = {*csv_dialect.MISSING, *stated.get("missing", ())}
    summary = _rows_of_text([lines[line] for line in filled], dialect, missing)
    filled = filled[: len(filled) - summary]
    if not filled:
        raise ReadError([f"{path}: no data below the header; write one line per sample"])
    columns, wide = _columns([lines[line] for line in filled], dialect)
    if wide:
        row, count = wide
        fault = f"{count} cells; the header has {dialect.width}, and so must each line"
        raise ReadError([f"{path}:{filled[row] + 1}: {fault}"])
    thousands = csv_dialect.THOUSANDS.get(stated.get("thousands", ""), "")
    channels = {
        name: _channel(cells, dialect.names[place], unit, (dialect.decimal, thousands), missing)
        for name, cells, place, unit in zip(names, columns, dialect.places, dialect.units, strict=True)
    }
    form = [
        dialect.described(),
        f"{len(repeated)} lines of further headers left out" if repeated else "",
        f"{counted(summary, 'line')} of text below the data left out" if summary else "",
    ]
    return Table(channels, lambda sample: f"{path}:{filled[sample] + 1}", ", ".join(filter(None, form)))


def _rows_of_text(lines: Sequence[str], dialect: Dialect, missing: set[str]) -> int:
    """The number of lines at the end with a word in the first wanted column, as above means of columns."""
    place = min(dialect.places)
    for count, line in enumerate(reversed(lines)):
        cell = (csv_dialect.split(line, dialect.delimiter)[place : place + 1] or [""])[0]
        if cell in missing or not (cell[0].isalpha() or not any(map(str.isdigit, cell))):
            return count
    return len(lines)


def _further_headers(lines: Sequence[str], dialect: Dialect) -> set[int]:
    """Lines of headers between the data, where each block of a recorder has its own.

    Each is the line above the data again, and what is no data above it, or begins as a line above the first
    data does: a recorder counts the samples of each block in one.
    """
    last = next((line for line in reversed(lines[: dialect.first]) if line.strip()), "")
    found = set[int]()
    if not last or _is_sample(last, dialect):
        return found
    begin = {line.split(dialect.delimiter)[0] for line in lines[: dialect.first]}
    begin = {first for first in begin if not csv_dialect.is_number(first.strip())}

    def is_header(line: str) -> bool:
        return not _is_sample(line, dialect) or line.split(dialect.delimiter)[0] in begin

    for place in range(dialect.first, len(lines)):
        if lines[place] == last:
            above = place
            while above >= dialect.first and above not in found and is_header(lines[above]):
                found.add(above)
                above -= 1
    return found


def _is_sample(line: str, dialect: Dialect) -> bool:
    cells = csv_dialect.split(line, dialect.delimiter)
    held = [cells[place] for place in dialect.places if place < len(cells)]
    return any(held) and all(map(csv_dialect.is_number, held))


def _header_faults(lines: Sequence[str], names: Sequence[Name], stated: Mapping[str, Any]) -> list[str]:
    """Faults of the header as "line: fault"."""
    place, header = csv_dialect.header(lines, stated)
    if not any(header):
        return [f"{place + 1}: empty; the first line must hold the names of the columns"]
    if all(csv_dialect.DECIMAL.fullmatch(name) for name in header) and not all(
        isinstance(n, int) for n in names
    ):
        named = ", ".join(str(name) for name in names)
        advice = f"write the names of the columns above them, such as {named}, or give columns by number"
        return [f"{place + 1}: numbers, where the header is expected; {advice}"]
    if len(header) == 1 and len(names) > 1:
        advice = "separate columns by commas, semicolons or tabs"
        return [f"{place + 1}: only one column, {show(header[0])}; {advice}"]
    absent = [name for name in names if csv_dialect.place_of(name, header) is None]
    return [
        f"{place + 1}: no column {show(name)}; {hint(str(name), [each for each in header if each])}"
        for name in absent
    ] or [f"{place + 1}: no line of numbers in the columns that are given by number"]


def _columns(lines: Sequence[str], dialect: Dialect) -> tuple[list[list[str]], tuple[int, int] | None]:
    """Cells of each wanted column, empty where a row ends early; and the place and width of a long row."""
    columns: list[list[str]] = [[] for _ in dialect.places]
    pairs = list(zip(columns, dialect.places, strict=True))
    for row, line in enumerate(lines):
        cells = csv_dialect.split(line, dialect.delimiter)
        if len(cells) > dialect.width and any(cells[dialect.width :]):
            return columns, (row, len(cells))
        for column, place in pairs:
            column.append(cells[place] if place < len(cells) else "")
    return columns, None


def _channel(cells: list[str], name: str, unit: str, signs: tuple[str, str], missing: set[str]) -> Channel:
    """Numbers or dates in the cells of a column; ``signs``: of decimals and of thousands."""
    first = next((cell for cell in cells if cell not in missing), "")
    if DATE.match(first):
        seconds, faults = seconds_of_dates(["" if cell in missing else cell for cell in cells])
        return Channel(seconds, DATETIME, faults={row: f"{name}: {fault}" for row, fault in faults.items()})
    decimal, thousands = signs
    plain = [cell.replace(thousands, "") for cell in cells] if thousands else cells
    other = next(sign for sign in csv_dialect.DECIMALS.values() if sign != decimal)
    if any(other in cell for cell in plain):
        plain = [
            _ungrouped(cell, other) if cell.rfind(decimal) > cell.rfind(other) else cell for cell in plain
        ]
    if decimal == ",":
        plain = [cell.replace(",", ".") for cell in plain]
    try:
        values = np.array(plain, float)
    except ValueError:
        values = np.array([_number(cell) for cell in plain])
    faults = {
        row: f"{name}: {show(cells[row])} is not a finite number; write one"
        for row in np.flatnonzero(~np.isfinite(values)).tolist()
        if cells[row] not in missing
    }
    for row in (
        np.flatnonzero([cell in missing for cell in cells]) if missing - {*csv_dialect.MISSING} else ()
    ):
        values[row] = np.nan
    return Channel(values, unit, faults=faults)


def _ungrouped(cell: str, sign: str) -> str:
    """A number without a sign between its thousands; any other text as it is."""
    return cell.replace(sign, "") if csv_dialect.GROUPED.fullmatch(cell) else cell


def _number(cell: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        return np.nan
    return np.nan if isinf(value) else value
