"""Numbers of the columns of a CSV file; faults name their line."""

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from wedgesweep.csv_files import dialect as csv_dialect
from wedgesweep.csv_files.dialect import Dialect
from wedgesweep.files import read_bytes
from wedgesweep.hints import hint, show

# A number with either decimal sign.
DECIMAL = re.compile(r"[+-]?\d*[.,]?\d+([eE][+-]?\d+)?")
# Number of faulty lines that are listed per file; the others are counted.
LISTED = 3


class Content(NamedTuple):
    """Columns by channel, each of shape (n,), and the line (from 1) of each row.

    ``units``: those that the file names, by channel; ``form``: how it is written where that is unusual.
    """

    columns: dict[str, np.ndarray]
    lines: np.ndarray
    units: Mapping[str, str] = {}
    form: str = ""

    def where(self, file: Path) -> Callable[[int], str]:
        """The place of a sample in a file of lines, by its index."""
        return lambda sample: f"{file}:{self.lines[sample]}"


NOTHING = Content({}, np.array([], int))


def read(
    path: Path, wanted: Mapping[str, str], problems: list[str], stated: Mapping[str, Any] | None = None
) -> Content:
    """Read the wanted columns.

    ``wanted`` maps each channel to its header name, ``stated`` is the table measurement.csv. Faults are
    appended to ``problems``; then the result is empty.
    """
    stated = stated or {}
    try:
        text, encoding = csv_dialect.decode(read_bytes(path), stated.get("encoding"))
        lines = csv_dialect.LINE_END.split(text)
        dialect = csv_dialect.detect(lines, encoding, wanted, stated)
    except OSError as error:
        problems.append(f"{path}: {error.strerror}; give the path of a CSV file")
        return NOTHING
    except ValueError as error:
        problems.append(f"{path}: {error}")
        return NOTHING
    faults = _header_faults(lines, dialect, wanted, stated)
    if dialect is None or faults:
        problems.extend(f"{path}:{fault}" for fault in faults)
        return NOTHING
    first = dialect.header + 1
    filled = [place for place in range(first, len(lines)) if not csv_dialect.is_skipped(lines[place])]
    rows = np.array(filled[bool(dialect.units) :], int)
    if not rows.size:
        problems.append(f"{path}: no data below the header; write one line per sample")
        return NOTHING
    columns = _numbers(path, [lines[place] for place in rows], rows + 1, dialect, wanted, problems)
    units = dict(zip(wanted, dialect.units, strict=True)) if dialect.units else {}
    return Content(columns, rows + 1, units, dialect.described()) if columns else NOTHING


def _header_faults(
    lines: Sequence[str], dialect: Dialect | None, wanted: Mapping[str, str], stated: Mapping[str, Any]
) -> list[str]:
    """Faults of the header as "line: fault"."""
    place, header = csv_dialect.header(lines, stated)
    if dialect is not None:
        place, header = dialect.header, list(dialect.names)
    if dialect is None and any(header) and all(DECIMAL.fullmatch(name) for name in header):
        advice = f"write the names of the columns above them, such as {', '.join(wanted.values())}"
        return [f"{place + 1}: numbers, where the header is expected; {advice}"]
    if not any(header):
        return [f"{place + 1}: empty; the first line must hold the names of the columns"]
    repeated = [name for name, times in Counter(header).items() if times > 1 and name in wanted.values()]
    if repeated:
        name = repeated[0]
        return [f"{place + 1}: column {show(name)} occurs {header.count(name)} times; names must be unique"]
    if len(header) == 1 and len(wanted) > 1:
        advice = "separate columns by commas, semicolons or tabs"
        return [f"{place + 1}: only one column, {show(header[0])}; {advice}"]
    return [
        f"{place + 1}: no column {show(name)} ({channel}); {hint(name, [each for each in header if each])}"
        for channel, name in wanted.items()
        if name not in header
    ]


def _numbers(
    path: Path,
    lines: Sequence[str],
    numbers: np.ndarray,
    dialect: Dialect,
    wanted: Mapping[str, str],
    problems: list[str],
) -> dict[str, np.ndarray]:
    places = {channel: dialect.names.index(name) for channel, name in wanted.items()}
    at_once = _all_at_once(lines, dialect)
    if at_once is not None and np.isfinite(at_once[:, list(places.values())]).all():
        return {channel: at_once[:, place].copy() for channel, place in places.items()}
    faults, rows = [], []
    for number, line in zip(numbers.tolist(), lines, strict=True):
        cells = csv_dialect.split(line, dialect.delimiter)
        if len(cells) != len(dialect.names):
            fault = f"{len(cells)} cells; the header has {len(dialect.names)}, and so must each line"
            faults.append(f"{path}:{number}: {fault}")
            continue
        row = [_number(cells[place], dialect.decimal) for place in places.values()]
        for place, value in zip(places.values(), row, strict=True):
            if value is None:
                wrong = show(cells[place]) if cells[place] else "an empty cell"
                fault = f"{dialect.names[place]}: {wrong} is not a finite number; write one"
                faults.append(f"{path}:{number}: {fault}")
        rows.append(row)
    problems.extend(faults[:LISTED])
    if len(faults) > LISTED:
        problems.append(f"{path}: {len(faults) - LISTED} more such faults")
    if faults:
        return {}
    return dict(zip(places, np.array(rows, float).T.copy(), strict=True))


def _all_at_once(lines: Sequence[str], dialect: Dialect) -> np.ndarray | None:
    """All numbers of plain lines, shape (n, columns); None if some line does not hold just these."""
    if dialect.decimal == ",":
        if dialect.delimiter == ",":
            return None
        lines = [line.replace(",", ".") for line in lines]
    delimiter = None if dialect.delimiter == " " else dialect.delimiter
    try:
        rows = np.loadtxt(lines, delimiter=delimiter, comments=None, ndmin=2)
    except ValueError:
        return None
    return rows if rows.shape[1] == len(dialect.names) else None


def _number(cell: str, decimal: str) -> float | None:
    try:
        value = float(cell.replace(",", ".") if decimal == "," else cell)
    except ValueError:
        return None
    return value if isfinite(value) else None
