"""What a reader finds in a file: channels by the names that were asked for."""

import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

import numpy as np

from wedgesweep.hints import hint, show
from wedgesweep.units import DAY, is_unit, usual

# A column by its name or by its number, from 1.
Name = str | int
# The unit of time stamps that are dates; their values are seconds since midnight of the first day.
DATETIME = "datetime"
# A date in any order, or a number of days, either of which may be missing; a time of day; what follows it, or
# AM and PM.
DATE = re.compile(
    r"\s*(?:\d+ days?,?\s+)?(?:(\d{1,4})([-./])(\d{1,2})\2(\d{1,4})(?:T|\s+))?"
    r"(\d{1,2})(:\d\d(?(1)|:\d\d)[^\sAaPp]*)\s*([AaPp])?[.Mm]*\s*$"
)
# The day of times without one.
DAYLESS, DAYLESS_YEAR = "1970-01-01", 1970
# The second of several columns with a name, and a column of a matrix.
REPEATED, OF_A_MATRIX = re.compile(r"(.*)#(\d+)"), re.compile(r"(.*)\[(\d+)\]")
# Fields of a struct with the unit and the name of its samples.
UNIT_FIELDS, NAME_FIELDS = ("unit", "units", "einheit"), ("name", "label", "title")
BRACKETS = re.compile(r"(.*?)\s*[\[(]([^\[\]()]*)[\])]\s*")


class ReadError(ValueError):
    """A file that cannot be read; ``problems`` name the file."""

    def __init__(self, problems: Sequence[str]) -> None:
        super().__init__("\n".join(problems))
        self.problems = tuple(problems)


@dataclass(frozen=True, eq=False)
class Channel:
    """Samples (n,), NaN where missing; the unit that the file names, and a clock (s) of the channel's own.

    ``faults``: of single samples, by their index; ``label``: what is measured, beside the channel's name.
    """

    values: np.ndarray
    unit: str = ""
    clock: np.ndarray | None = None
    faults: Mapping[int, str] = field(default_factory=dict)
    label: str = ""


@dataclass(frozen=True, eq=False)
class Table:
    """Channels by name or number, the place of a sample in the file, and the form of an unusual file."""

    channels: Mapping[Name, Channel]
    where: Callable[[int], str]
    form: str = ""


def place_of(name: Name, cells: Sequence[str]) -> int | None:
    """Index of a column among the names in a header, None if it is not there; raises ValueError.

    ``d`` is also the column ``d [mm]`` or ``d (mm)``, and ``d#2`` the second one called ``d``.
    """
    if isinstance(name, int):
        return name - 1 if name <= len(cells) else None
    repeated = REPEATED.fullmatch(name)
    for spelled in (list(cells), [split_unit(cell)[0] for cell in cells]):
        found = [place for place, cell in enumerate(spelled) if cell == name]
        if len(found) > 1:
            fault = f"column {show(name)} occurs {len(found)} times; write {show(name + '#2')} for the second"
            raise ValueError(fault)
        if not found and repeated:
            found = [place for place, cell in enumerate(spelled) if cell == repeated[1]]
            found = found[int(repeated[2]) - 1 :][:1] if int(repeated[2]) else []
        if found:
            return found[0]
    return None


def split_unit(header: str) -> tuple[str, str]:
    """Name and unit of a header such as ``d [mm]``, ``d (mm)`` or ``d/mm``."""
    found = BRACKETS.fullmatch(header)
    if found and found[1].strip():
        return found[1].strip(), found[2].strip()
    name, _, unit = (part.strip() for part in header.partition("/"))
    if name and is_unit(usual(unit)) and not is_unit(usual(header.strip())):
        return name, unit
    return header, ""


def unit_and_name(words: Mapping[str, str]) -> tuple[str, str]:
    """Unit and name of samples by the words beside them; empty where there is none."""
    known = {key.lower(): word for key, word in words.items()}
    unit, name = (next(filter(None, map(known.get, keys)), "") for keys in (UNIT_FIELDS, NAME_FIELDS))
    return unit, name


def texts_of_columns(texts: Mapping[str, Sequence[str]], values: np.ndarray) -> list[dict[str, str]]:
    """For each column of a matrix the texts of lists beside it that have one for each; else empty."""
    count, size = matrix_of(np.atleast_1d(values)).shape[-1], values.size
    lists = {key: each for key, each in texts.items() if 1 < len(each) == count < size}
    return [{key: each[i] for key, each in lists.items()} for i in range(count)] if lists else []


def seconds_of_dates(values: Sequence[Any]) -> tuple[np.ndarray, dict[int, str]]:
    """Seconds (n,) since midnight of the first day, and faults: of texts, dates or None.

    Where the year is last, the day or the month is first, whichever makes the shorter record.
    """
    texts = [value for value in values if isinstance(value, str) and DATE.match(value)]
    spans = {}
    for day_first in (False, True):
        with suppress(ValueError):
            start, end = (
                datetime.fromisoformat(_iso(text, day_first)[:10]) for text in (texts[:1] + texts[-1:])
            )
            spans[abs(end - start)] = day_first
    day_first = spans[min(spans)] if spans else False
    first: datetime | None = None
    seconds, faults = np.full(len(values), np.nan), {}
    for row, value in enumerate(values):
        if value is None or value in ("", "nan") or value != value:
            continue
        try:
            stamp = value if isinstance(value, datetime) else datetime.fromisoformat(_iso(value, day_first))
        except ValueError:
            faults[row] = f"{show(str(value))} is no date or time"
            continue
        stamp = stamp.astimezone(UTC) if stamp.tzinfo else stamp.replace(tzinfo=UTC)
        first = first or stamp.replace(hour=0, minute=0, second=0, microsecond=0)
        since = stamp - first
        seconds[row] = since.days * DAY + since.seconds + 1e-6 * since.microseconds
    if first is not None and first.year == DAYLESS_YEAR:  # midnight may have passed
        known = np.isfinite(seconds)
        seconds[known] = np.unwrap(seconds[known], period=DAY)
    return seconds, faults


def _iso(value: Any, day_first: bool) -> str:
    """A date or time as ISO 8601 has it; what is none stays as it is."""
    text = str(value).strip()
    found = DATE.match(text)
    if not found:
        return text
    start, _, middle, end, hour, rest, half = found.groups()
    if half:
        hour = str(int(hour) % 12 + 12 * (half in "Pp"))
    day = DAYLESS
    if start:
        year, month, date = (start, middle, end) if len(start) > 2 else (end, start, middle)
        month, date = (date, month) if day_first and len(start) <= 2 else (month, date)
        day = f"{year:0>4}-{month:0>2}-{date:0>2}"
    return f"{day} {hour:0>2}{rest}"


def channel_of(values: Any, unit: str = "", clock: np.ndarray | None = None) -> Channel:
    """A list, row or column of real numbers or dates; raises ValueError."""
    array = np.ma.filled(values, np.nan) if isinstance(values, np.ma.MaskedArray) else np.asarray(values)
    if max(array.shape, default=0) != array.size:
        shape = " x ".join(map(str, array.shape))
        fault = f"holds {shape} numbers; name one column of a matrix, as in [2]"
        raise ValueError(fault)
    array = array.ravel()
    if array.dtype.kind == "M":
        micro = array.astype("datetime64[us]")
        days = micro - micro[:1].astype("datetime64[D]")
        return Channel(days / np.timedelta64(1, "s"), DATETIME, clock)
    if array.dtype.kind in "OUS" and array.size and (isinstance(array[0], datetime) or _is_date(array[0])):
        seconds, faults = seconds_of_dates(list(array))
        return Channel(seconds, DATETIME, clock, faults)
    if array.dtype.kind not in "fiu" or not array.size:
        fault = "is no list of real numbers"
        raise ValueError(fault)
    numbers = array.astype(float)
    infinite = np.flatnonzero(np.isinf(numbers)).tolist()
    return Channel(numbers, unit, clock, {row: f"{numbers[row]} is not a finite number" for row in infinite})


def _is_date(value: Any) -> bool:
    return DATE.match(value.decode("latin-1") if isinstance(value, bytes) else str(value)) is not None


@dataclass(frozen=True)
class Wanted:
    """Variables that are asked for, out of those of a binary file; all of them without any name."""

    names: tuple[Name, ...] = ()

    def __call__(self, variable: str, number: int) -> bool:
        """Whether a variable, the given one of the file from 1, is asked for; a dot may be a slash."""
        bases = [OF_A_MATRIX.sub(r"\1", name) for name in self.names if isinstance(name, str)]
        asked = {*self.names, *bases}
        return not asked or number in asked or variable in asked or variable.replace("/", ".") in asked

    def picked(self, variables: Mapping[str, Channel | None]) -> dict[Name, Channel]:
        """The channels by their names, of variables as stored; None where a variable is not asked for."""
        found, faults = {}, []
        for name in self.names:
            try:
                found[name] = _picked(name, variables)
            except ValueError as error:
                faults.append(str(error))
        if faults:
            raise ReadError(faults)
        return found


def _picked(name: Name, variables: Mapping[str, Channel | None]) -> Channel:
    listed, column = list(variables), None
    spelled = {variable.replace("/", "."): variable for variable in listed} | {each: each for each in listed}
    matrix = OF_A_MATRIX.fullmatch(name) if isinstance(name, str) and name not in spelled else None
    if matrix:
        name, column = matrix[1], int(matrix[2])
    key = listed[name - 1 : name] if isinstance(name, int) else [spelled[name]] if name in spelled else []
    stored = variables[key[0]] if key else None
    if not key:
        fault = f"no variable {show(name)}; {hint(str(name), listed)}"
        raise ValueError(fault)
    try:
        values = None if stored is None else stored.values
        if column is not None:
            values = _column(np.asarray(values), column)
        return channel_of(values, stored.unit if stored else "", stored.clock if stored else None)
    except ValueError as error:
        raise ValueError(f"variable {show(name)} {error}") from error


def matrix_of(values: np.ndarray) -> np.ndarray:
    """A matrix with a row for each sample; Simulink logs k signals as k x 1 x n, or k x n."""
    matrix = values.squeeze() if values.squeeze().ndim == 2 else values
    return matrix.T if matrix.ndim == 2 and matrix.shape[0] < matrix.shape[1] else matrix


def _column(values: np.ndarray, number: int) -> np.ndarray:
    matrix = matrix_of(values)
    if matrix.ndim != 2 or not 1 <= number <= matrix.shape[1]:
        fault = f"holds {' x '.join(map(str, matrix.shape))} numbers, and no column {number}"
        raise ValueError(fault)
    return matrix[:, number - 1]
