"""How a CSV file is written: encoding, separator, decimal sign, and the lines above the data.

What is not stated is detected where the file leaves no doubt: the header is the first line that, split by
some separator, holds the name of every wanted column.
"""

import codecs
import csv
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from wedgesweep.units import UNITS, usual

DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "space": " "}
DECIMALS = {"point": ".", "comma": ","}
COMMENTS = ("#", "%")
# Lines in which the header is sought.
DEEPEST_HEADER = 200
MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
# Beginnings of files that are no text, and what they are.
BINARY = (
    (b"PK\x03\x04", "a zip archive, as workbooks of Excel are; export it as CSV"),
    (b"\xd0\xcf\x11\xe0", "a workbook of Excel or another document; export it as CSV"),
    (b"\x1f\x8b", "compressed by gzip; unpack it"),
    (b"\x89HDF", "an HDF5 file; end its name with .h5, or with .mat if it is MATLAB's"),
    (b"MATLAB 5.0 MAT-file", "a file of MATLAB; end its name with .mat"),
    (b"PAR1", "a Parquet file; end its name with .parquet"),
)
NO_TEXT = "holds null characters, so that it is no text; export it as CSV"
LINE_END = re.compile(r"\r\n|\n|\r")
DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")


@dataclass(frozen=True)
class Dialect:
    """How a file is written; ``units`` are the cells of a row of units below the header, or empty."""

    encoding: str
    delimiter: str
    decimal: str
    header: int
    names: tuple[str, ...]
    units: tuple[str, ...] = ()

    def described(self) -> str:
        """What differs from comma-separated UTF-8 with the header in the first line, in words."""
        delimiter = next(name for name, sign in DELIMITERS.items() if sign == self.delimiter)
        said = (
            (self.encoding not in ("utf-8", "utf-8-sig"), self.encoding),
            (self.delimiter != ",", f"{delimiter}-separated"),
            (self.decimal != ".", "decimal commas"),
            (self.header > 0, f"header in line {self.header + 1}"),
            (bool(self.units), "a row of units"),
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
        message = f'no encoding "{encoding}"; valid here: utf-8, utf-16, latin-1 and the others of Python'
        raise ValueError(message) from error
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
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8"


def split(line: str, delimiter: str) -> list[str]:
    """Cells of a line; a line that cannot be split is one cell."""
    if delimiter == " ":
        return line.split()
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter), [])]
    except csv.Error:  # a cell of over 100,000 characters
        return [line]


def detect(
    lines: Sequence[str], encoding: str, wanted: Mapping[str, str], stated: Mapping[str, Any]
) -> Dialect | None:
    """The dialect of a file that has the ``wanted`` columns; None if no line names them all.

    Raises ValueError if the decimal sign is in doubt.
    """
    names = set(wanted.values())
    for place, delimiter, cells in _candidates(lines, stated):
        if names <= set(cells):
            data = (split(line, delimiter) for line in lines[place + 1 :] if not is_skipped(line))
            first = [cells for _, cells in zip(range(DEEPEST_HEADER), data, strict=False)]
            columns = [cells.index(name) for name in wanted.values()]
            units = _units(first, columns, len(cells))
            decimal = DECIMALS.get(stated.get("decimal", "")) or _decimal(first[bool(units) :], columns)
            return Dialect(encoding, delimiter, decimal, place, tuple(cells), units)
    return None


def header(lines: Sequence[str], stated: Mapping[str, Any]) -> tuple[int, list[str]]:
    """The first line that is not skipped, from 0, and its cells as split by the likeliest separator."""
    likely = [each for each in _candidates(lines, stated) if not is_skipped(lines[each[0]])]
    first = [each for each in likely if each[0] == likely[0][0]]
    place, _, cells = max(first, key=lambda each: len(each[2]) * (each[1] != " "), default=(0, ",", []))
    return place, cells


def is_skipped(line: str) -> bool:
    """Whether a line is empty or a comment."""
    return not line.strip() or line.lstrip().startswith(COMMENTS)


def _candidates(lines: Sequence[str], stated: Mapping[str, Any]) -> Iterator[tuple[int, str, list[str]]]:
    """Lines that may be the header, separators, and the cells; a comment may be the header too."""
    delimiters = [DELIMITERS[stated["delimiter"]]] if "delimiter" in stated else DELIMITERS.values()
    start = stated.get("skip_rows", 0)
    for place, line in enumerate(lines[start : start + DEEPEST_HEADER], start):
        for delimiter in delimiters:
            yield place, delimiter, split(line, delimiter)
            if line.startswith(COMMENTS):
                yield place, delimiter, split(line[1:], delimiter)


def _units(rows: Sequence[Sequence[str]], columns: Sequence[int], width: int) -> tuple[str, ...]:
    """The first row, if it has words only, and some are units: mm or, in brackets, anything."""
    if not rows or len(rows[0]) != width:
        return ()
    cells = [rows[0][column] for column in columns]
    words = not any(character.isdigit() for cell in cells for character in bare(cell)[:1])
    return tuple(bare(cell) for cell in cells) if words and any(map(_is_unit, cells)) else ()


def bare(cell: str) -> str:
    """A unit without its brackets, in its usual spelling."""
    inner = cell.strip().removeprefix("[").removesuffix("]").removeprefix("(").removesuffix(")").strip()
    return usual(inner)


def _is_unit(cell: str) -> bool:
    bracketed = cell[:1] + cell[-1:] in ("[]", "()")
    return bracketed or any(bare(cell) in units for units in UNITS.values())


def _decimal(rows: Sequence[Sequence[str]], columns: Sequence[int]) -> str:
    """The decimal sign of the cells of some columns; raises ValueError if commas may part thousands."""
    cells = [row[column] for row in rows for column in columns if column < len(row)]
    commas = [cell for cell in cells if DECIMAL_COMMA.fullmatch(cell)]
    if not commas:
        return "."
    if all(map(THOUSANDS.fullmatch, commas)) or any("." in cell for cell in cells):
        message = f'"{commas[0]}" may be a decimal or thousands; state measurement.csv.decimal'
        raise ValueError(message)
    return ","
