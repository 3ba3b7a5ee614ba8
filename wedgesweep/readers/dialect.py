"""How a CSV file is written: encoding, separator, decimal sign, and the lines above the data.

What is not stated is detected where the file leaves no doubt: the header is the first line that, split by
some separator, holds the name of every wanted column. Where columns are given by number, or their names
stand in several lines, the data begin at the first line that holds numbers.
"""

import codecs
import csv
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from wedgesweep.readers.table import DATE, Name, place_of, split_unit
from wedgesweep.units import UNITS, usual

DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "space": " "}
DECIMALS = {"point": ".", "comma": ","}
THOUSANDS = {"comma": ",", "point": ".", "space": " ", "apostrophe": "'"}
COMMENTS = ("#", "%")
# Cells that stand for a missing sample.
MISSING = ("", "NA", "NaN", "nan", "NAN", "#N/A")
# Lines in which the header is sought, and lines that show where the data begin.
DEEPEST_HEADER, FIRST_ROWS = 200, 3
MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
# Beginnings of files that are no text, and what they are.
BINARY = (
    (b"PK\x03\x04", "a zip archive; a workbook of Excel must end in .xlsx, arrays of numpy in .npz"),
    (b"\xd0\xcf\x11\xe0", "an old workbook of Excel or another document; save it as .xlsx or CSV"),
    (b"\x1f\x8b", "compressed by gzip; unpack it"),
    (b"\x89HDF", "an HDF5 file; end its name with .h5, or with .mat if it is MATLAB's"),
    (b"MATLAB 5.0 MAT-file", "a file of MATLAB; end its name with .mat"),
    (b"PAR1", "a Parquet file; end its name with .parquet"),
    (b"RIFF", "a WAV file; end its name with .wav"),
    (b"TDSm", "a TDMS file; end its name with .tdms"),
)
NO_TEXT = "holds null characters, so that it is no text; export it as CSV"
LINE_END = re.compile(r"\r\n|\n|\r")
DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
IN_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")
# A number with a sign for thousands and the other one for decimals, and one with either sign for decimals.
GROUPED = re.compile(r"[+-]?\d{1,3}((\.\d{3})+,|(,\d{3})+\.)\d+")
DECIMAL = re.compile(rf"{GROUPED.pattern}|[+-]?(\d+[.,]?\d*|[.,]\d+)([eE][+-]?\d+)?")


class Header(NamedTuple):
    """The line of the names, None where there is none; its cells; places and units of wanted columns."""

    line: int | None
    cells: Sequence[str]
    places: Sequence[int]
    units: Sequence[str]


@dataclass(frozen=True)
class Dialect:
    """How a file is written.

    ``first``: index of the first line of data; ``header``: that of the line of names, None if there is none;
    ``places``: of the wanted columns in a line of ``width`` cells; ``units``: those that the file names, or
    empty; ``unit_row``: whether they have a row of their own.
    """

    encoding: str
    delimiter: str
    decimal: str
    first: int
    header: int | None
    places: tuple[int, ...]
    width: int
    names: tuple[str, ...]
    units: tuple[str, ...]
    unit_row: bool = False

    def described(self) -> str:
        """What differs from comma-separated UTF-8 with the header in the first line, in words."""
        delimiter = next(name for name, sign in DELIMITERS.items() if sign == self.delimiter)
        said = (
            (self.encoding not in ("utf-8", "utf-8-sig"), self.encoding),
            (self.delimiter != ",", f"{delimiter}-separated"),
            (self.decimal != ".", "decimal commas"),
            (self.header is not None and self.header > 0, f"header in line {(self.header or 0) + 1}"),
            (self.header is None, f"data from line {self.first + 1}"),
            (self.unit_row, "a row of units"),
        )
        return ", ".join(text for differs, text in said if differs)


def decode(content: bytes, encoding: str | None) -> tuple[str, str]:
    """Text of a file, and its encoding; raises ValueError if it is no text."""
    for mark, what in BINARY:
        if content.startswith(mark):
            raise ValueError(what)
    stated, encoding = encoding, encoding or _encoding(content)
    try:
        text = content.decode(encoding)
    except LookupError as error:
        raise ValueError(
            f'no encoding "{encoding}"; valid here: utf-8, utf-16, latin-1 and the others of Python'
        ) from error
    except UnicodeDecodeError as error:
        message = f"not {encoding} text (byte {error.start}); state another measurement.csv.encoding"
        if stated is None and b"\0" in content:
            message = NO_TEXT
        raise ValueError(message) from error
    if "\0" in text:
        raise ValueError(NO_TEXT)
    return text, encoding


def _encoding(content: bytes) -> str:
    for mark, encoding in MARKS:
        if content.startswith(mark):
            return encoding
    if content[1:200:2].count(0) > content[0:200:2].count(0):
        return "utf-16-le"
    if content[0:200:2].count(0) > content[1:200:2].count(0):
        return "utf-16-be"
    # Pairs of bytes of GB 2312 are hardly ever a text of any other language, whose letters are single bytes.
    for encoding, found in (("utf-8", "utf-8"), ("gb2312", "gb18030")):
        try:
            content.decode(encoding)
        except UnicodeDecodeError:
            continue
        return found
    return "latin-1"


def split(line: str, delimiter: str) -> list[str]:
    """Cells of a line; a line that cannot be split is one cell."""
    if delimiter == " ":
        return line.split()
    if '"' not in line:  # several times as fast
        return [cell.strip() for cell in line.split(delimiter)] if line else []
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter), [])]
    except csv.Error:  # a cell of over 100,000 characters
        return [line]


def detect(
    lines: Sequence[str], encoding: str, names: Sequence[Name], stated: Mapping[str, Any]
) -> Dialect | None:
    """The dialect of a file that has the named columns; None if no line names them all.

    Raises ValueError if the decimal sign, or which column is meant, is in doubt.
    """
    named = any(isinstance(name, str) for name in names)
    for line, delimiter, cells in _candidates(lines, stated) if named else ():
        places = [place_of(name, cells) for name in names]
        if None not in places:
            found = [place for place in places if place is not None]
            units = [split_unit(cells[place])[1] for place in found]
            written = Header(line, cells, found, units)
            return _below(lines, line + 1, (encoding, delimiter), written, stated)
    return _by_first_numbers(lines, encoding, names, stated)


def header(lines: Sequence[str], stated: Mapping[str, Any]) -> tuple[int, list[str]]:
    """The first line that is not skipped, from 0, and its cells as split by the likeliest separator."""
    likely = [each for each in _candidates(lines, stated) if not is_skipped(lines[each[0]])]
    first = [each for each in likely if each[0] == likely[0][0]]
    place, _, cells = max(first, key=lambda each: len(each[2]) * (each[1] != " "), default=(0, ",", []))
    return place, cells


def is_skipped(line: str) -> bool:
    """Whether a line is empty or a comment."""
    return not line.strip() or line.lstrip().startswith(COMMENTS)


def is_number(cell: str) -> bool:
    """Whether a cell may be a sample: a number with either decimal sign, a date, or missing."""
    return cell in MISSING or DECIMAL.fullmatch(cell) is not None or DATE.match(cell) is not None


def _candidates(lines: Sequence[str], stated: Mapping[str, Any]) -> Iterator[tuple[int, str, list[str]]]:
    """Lines that may be the header, separators, and the cells; a comment may be the header too."""
    start = stated.get("skip_rows", 0)
    for place, line in enumerate(lines[start : start + DEEPEST_HEADER], start):
        for delimiter in _delimiters(stated):
            yield place, delimiter, split(line, delimiter)
            if line.startswith(COMMENTS):
                yield place, delimiter, split(line[1:], delimiter)


def _delimiters(stated: Mapping[str, Any]) -> tuple[str, ...]:
    return (DELIMITERS[stated["delimiter"]],) if "delimiter" in stated else tuple(DELIMITERS.values())


def _by_first_numbers(
    lines: Sequence[str], encoding: str, names: Sequence[Name], stated: Mapping[str, Any]
) -> Dialect | None:
    """The dialect by where numbers begin: names may stand in any line above them, or be numbers."""
    start = stated.get("skip_rows", 0)
    filled = [i for i in range(start, min(len(lines), start + DEEPEST_HEADER)) if not is_skipped(lines[i])]
    found: list[tuple[int, str, int, list[int]]] = []
    for delimiter in _delimiters(stated):
        rows = [split(lines[i], delimiter) for i in filled]
        widest = max((len(row) for row in rows), default=0)
        first = _first_row(rows, names)
        if first is None or (widest < max(2, len(names)) and len(names) > 1):
            continue
        width = len(rows[first])
        places = [_place_above(name, rows[:first], width) for name in names]
        if None not in places:
            found.append((width, delimiter, first, [place for place in places if place is not None]))
    if not found:
        return None
    width, delimiter, first, columns = max(found, key=lambda each: (each[0], each[1] != " "))
    above = [split(lines[i], delimiter) for i in filled[:first]]
    cells = [f"column {number}" for number in range(1, width + 1)]
    units = [_unit_above(place, above) for place in columns]
    return _below(lines, filled[first], (encoding, delimiter), Header(None, cells, columns, units), stated)


def _first_row(rows: Sequence[Sequence[str]], names: Sequence[Name]) -> int | None:
    """Index of the first row from which on the columns given by number, or most cells, hold numbers."""
    numbers = [name - 1 for name in names if isinstance(name, int)]

    def holds(row: Sequence[str]) -> bool:
        known = [place < len(row) and is_number(row[place]) for place in numbers]
        filled = [is_number(cell) for cell in row if cell]
        return all(known) if known else 2 * sum(filled) > len(filled)

    data = [holds(row) for row in rows]
    starts = (i for i in range(len(rows)) if all(data[i : i + FIRST_ROWS]) and any(rows[i]))
    return next(starts, None)


def _place_above(name: Name, above: Sequence[Sequence[str]], width: int) -> int | None:
    """Index of a column among lines above the data; the lowest line that names it counts."""
    if isinstance(name, int):
        return name - 1 if name <= width else None
    found = (place_of(name, cells) for cells in reversed(above))
    return next((place for place in found if place is not None and place < width), None)


def _unit_above(place: int, above: Sequence[Sequence[str]]) -> str:
    """The unit of a column in the lines above the data: in a cell below its name, or behind the name."""
    cells = [row[place] for row in above if place < len(row) and row[place]]
    for row, cell in reversed(list(enumerate(cells))):
        if unit := bare(cell) if row and _is_unit(cell) else split_unit(cell)[1]:
            return unit
    return ""


def _below(
    lines: Sequence[str],
    first: int,
    signs: tuple[str, str],
    written: Header,
    stated: Mapping[str, Any],
) -> Dialect:
    """The dialect of a file whose data, or a row of units, begin at line ``first``."""
    encoding, delimiter = signs
    places = written.places
    below = [
        line for line in range(first, min(len(lines), first + DEEPEST_HEADER)) if not is_skipped(lines[line])
    ]
    rows = [split(lines[line], delimiter) for line in below]
    row_of_units = _units(rows, places)
    first = below[min(1, len(below) - 1)] if row_of_units and len(below) > 1 else (below or [first])[0]
    decimal = DECIMALS.get(stated.get("decimal", "")) or _decimal(rows[bool(row_of_units) :], places, stated)
    units = [
        own or other for own, other in zip(row_of_units or [""] * len(places), written.units, strict=True)
    ]
    names = tuple(written.cells)
    header = written.line, tuple(places), len(names), names, tuple(map(usual, units)), bool(row_of_units)
    return Dialect(encoding, delimiter, decimal, first, *header)


def _units(rows: Sequence[Sequence[str]], columns: Sequence[int]) -> list[str]:
    """The first row, if it has words only: some of them units, or all above a row of numbers."""
    if not rows or len(rows[0]) <= max(columns):
        return []
    cells = [rows[0][column] for column in columns]
    words = not any(character.isdigit() for cell in cells for character in bare(cell)[:1])
    below = rows[1:2] and all(is_number(rows[1][column]) for column in columns if column < len(rows[1]))
    above_numbers = below and not any(map(is_number, cells))
    return [bare(cell) for cell in cells] if words and (any(map(_is_unit, cells)) or above_numbers) else []


def bare(cell: str) -> str:
    """A unit without its brackets, in its usual spelling."""
    inner = cell.strip().removeprefix("[").removesuffix("]").removeprefix("(").removesuffix(")").strip()
    return usual(inner)


def _is_unit(cell: str) -> bool:
    bracketed = len(cell) > 2 and cell[:1] + cell[-1:] in ("[]", "()")
    return bracketed or any(bare(cell) in units for units in UNITS.values())


def _decimal(rows: Sequence[Sequence[str]], columns: Sequence[int], stated: Mapping[str, Any]) -> str:
    """The decimal sign of the cells of some columns; raises ValueError if commas may part thousands."""
    cells = [row[column] for row in rows for column in columns if column < len(row)]
    commas = [cell for cell in cells if DECIMAL_COMMA.fullmatch(cell)]
    if grouped := next(filter(GROUPED.fullmatch, cells), ""):
        return max(DECIMALS.values(), key=grouped.rfind)
    if not commas or stated.get("thousands") == "comma":
        return "."
    if all(map(IN_THOUSANDS.fullmatch, commas)) or any(
        "." in cell and DECIMAL.fullmatch(cell) for cell in cells
    ):
        raise ValueError(f'"{commas[0]}" may be a decimal or thousands; state measurement.csv.decimal')
    return ","
