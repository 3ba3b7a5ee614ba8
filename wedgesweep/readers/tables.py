"""Tables: Parquet, and workbooks of Excel (.xlsx)."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from wedgesweep.readers.dialect import FIRST_ROWS, MISSING
from wedgesweep.readers.extras import module
from wedgesweep.readers.table import Channel, Wanted, split_unit


def parquet(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Columns by name."""
    reader = module("pyarrow.parquet")
    names = reader.read_schema(file).names
    read = reader.read_table(file, columns=[name for i, name in enumerate(names, 1) if wanted(name, i)])
    found: dict[str, Channel | None] = dict.fromkeys(names)
    return found | {name: Channel(read[name].to_numpy()) for name in read.column_names}


def xlsx(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Columns by letter and by the text above their numbers; those of other sheets as ``Sheet2!F``.

    Numbers count the columns of the first sheet.
    """
    openpyxl = module("openpyxl")
    with file.open("rb") as stream:  # a damaged file would stay open in the library
        sheets = [
            (sheet.title, _columns(list(sheet.iter_rows(values_only=True))))
            for sheet in openpyxl.load_workbook(stream, read_only=True, data_only=True).worksheets
        ]
    columns: dict[str, Channel | None] = {}
    names: dict[str, Channel | None] = {}
    others: dict[str, Channel | None] = {}
    for number, (title, sheet) in enumerate(sheets):
        for place, (header, channel) in enumerate(sheet, 1):
            letter = openpyxl.utils.get_column_letter(place)
            sheet_names = {**({header: channel} if header else {}), letter: channel}
            others |= {f"{title}!{name}": channel for name in sheet_names}
            if number == 0:
                columns[header or letter] = channel
                names |= {name: channel for name in (letter, split_unit(header)[0]) if name}
    return {**columns, **{name: each for name, each in {**names, **others}.items() if name not in columns}}


def _columns(rows: Sequence[tuple]) -> list[tuple[str, Channel]]:
    """Name and samples of each column of a sheet, without titles above the names and summaries below."""
    width = max(map(len, rows), default=0)
    even = [row + (None,) * (width - len(row)) for row in rows]
    starts = [_start(cells) for cells in zip(*even, strict=True)]
    filled = [place for place, start in enumerate(starts) if start is not None]
    while even and (not any(even[-1]) or any(_is_text(even[-1][place]) for place in filled)):
        even.pop()
    names = [i for i, row in enumerate(even) if 2 * sum(map(_is_text, row)) > len(filled)]
    return [
        _channel(cells, start or 0, names)
        for cells, start in zip(zip(*even, strict=True), starts, strict=False)
    ]


def _start(cells: Sequence[Any]) -> int | None:
    """Index of the first number of a column with FIRST_ROWS cells that are no text, None without any."""
    text = [_is_text(cell) for cell in cells]
    starts = (i for i, cell in enumerate(cells) if cell is not None and not any(text[i : i + FIRST_ROWS]))
    return next(starts, None)


def _is_text(cell: Any) -> bool:
    return isinstance(cell, str) and cell.strip() not in MISSING


def _channel(cells: Sequence[Any], first: int, names: Sequence[int]) -> tuple[str, Channel]:
    """Name and samples of a column from its first number on: the texts above it are its name and its unit."""
    above = [i for i in range(first) if _is_text(cells[i])]
    texts = [cells[i].strip() for i in above if i in names] or [cells[i].strip() for i in above]
    unit = texts[1].strip("[]()") if len(texts) > 1 else ""
    values: Any = [
        float("nan") if cell is None or (isinstance(cell, str) and not _is_text(cell)) else cell
        for cell in cells[first:]
    ]
    header = texts[0] if texts else ""
    return header, Channel(values, unit or split_unit(header)[1])
