"""Numbers of the columns of a CSV file; faults name their line."""

import csv
from collections import Counter
from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path

import numpy as np

from wedgesweep.config.keys import hint, show

# Number of faulty lines that are listed per file; the others are counted.
LISTED = 3


Columns = tuple[dict[str, np.ndarray], np.ndarray]


def read(path: Path, wanted: Mapping[str, str], problems: list[str]) -> Columns:
    """Read the wanted columns, each of shape (n,), and the line number (from 1) of each row.

    ``wanted`` maps each channel to its header name. Faults are appended to ``problems``; then both
    results are empty.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        problems.append(f"{path}: not UTF-8 text (byte {error.start}); save it as UTF-8")
        return _NOTHING
    except OSError as error:
        problems.append(f"{path}: {error.strerror}; give the path of a CSV file")
        return _NOTHING
    header = [name.strip() for name in next(csv.reader(lines[:1]), [])]
    before = len(problems)
    problems.extend(f"{path}:1: {fault}" for fault in _header_faults(header, wanted))
    filled = np.array([place for place, line in enumerate(lines, 1) if line.strip()][1:], int)
    if len(problems) == before and not filled.size:
        problems.append(f"{path}: no data below the header; write one line per sample")
    if len(problems) > before:
        return _NOTHING
    places = {channel: header.index(name) for channel, name in wanted.items()}
    columns = _numbers(lines[1:], len(header), places)
    if columns is None:
        columns = _numbers_one_by_one(path, lines, filled, header, places, problems)
    return (columns, filled) if columns else _NOTHING


_NOTHING: Columns = ({}, np.array([], int))


def _header_faults(header: Sequence[str], wanted: Mapping[str, str]) -> list[str]:
    if not any(header):
        return ["empty; the first line must hold the names of the columns"]
    faults = [
        f"column {show(name)} occurs {times} times; names must be unique"
        for name, times in Counter(header).items()
        if times > 1 and name in wanted.values()
    ]
    if len(header) == 1 and len(wanted) > 1:
        faults.append(f"only one column, {show(header[0])}; separate columns by commas")
        return faults
    return faults + [
        f"no column {show(name)} ({channel}); {hint(name, [each for each in header if each])}"
        for channel, name in wanted.items()
        if name not in header
    ]


def _numbers(lines: Sequence[str], width: int, places: Mapping[str, int]) -> dict[str, np.ndarray] | None:
    """Parse all lines at once; None if a line does not hold ``width`` finite numbers."""
    try:
        rows = np.loadtxt(lines, delimiter=",", comments=None, ndmin=2)
    except ValueError:
        return None
    if rows.shape[1] != width or not np.isfinite(rows[:, list(places.values())]).all():
        return None
    return {channel: rows[:, place].copy() for channel, place in places.items()}


def _numbers_one_by_one(
    path: Path,
    lines: Sequence[str],
    filled: np.ndarray,
    header: Sequence[str],
    places: Mapping[str, int],
    problems: list[str],
) -> dict[str, np.ndarray] | None:
    """Parse cell by cell: other columns may hold text, and each fault names its line."""
    faults, rows = [], []
    for place, cells in zip(filled.tolist(), csv.reader(lines[i - 1] for i in filled), strict=True):
        if len(cells) != len(header):
            faults.append(f"{path}:{place}: {len(cells)} cells; the header has {len(header)}")
            continue
        row = [_number(cells[column]) for column in places.values()]
        for column, value in zip(places.values(), row, strict=True):
            if value is None:
                wrong = show(cells[column]) if cells[column].strip() else "an empty cell"
                faults.append(f"{path}:{place}: {header[column]}: {wrong} is not a finite number")
        rows.append(row)
    problems.extend(faults[:LISTED])
    if len(faults) > LISTED:
        problems.append(f"{path}: {len(faults) - LISTED} more such faults")
    if faults:
        return None
    return dict(zip(places, np.array(rows, float).T.copy(), strict=True))


def _number(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if isfinite(value) else None
