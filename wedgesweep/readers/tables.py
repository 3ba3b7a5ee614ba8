"""Tables: Parquet, and workbooks of Excel (.xlsx)."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

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
            (sheet.title, _even(list(sheet.iter_rows(values_only=True))))
            for sheet in openpyxl.load_workbook(stream, read_only=True, data_only=True).worksheets
        ]
    columns: dict[str, Channel | None] = {}
    names: dict[str, Channel | None] = {}
    others: dict[str, Channel | None] = {}
    for number, (title, rows) in enumerate(sheets):
        for place, cells in enumerate(zip(*rows, strict=True), 1):
            header, channel = _channel(cells)
            letter = openpyxl.utils.get_column_letter(place)
            sheet_names = {letter: channel, **({header: channel} if header else {})}
            others |= {f"{title}!{name}": channel for name in sheet_names}
            if number == 0:
                columns[header or letter] = channel
                names |= {name: channel for name in (letter, split_unit(header)[0]) if name}
    return {**columns, **{name: each for name, each in {**names, **others}.items() if name not in columns}}


def _even(rows: Sequence[tuple]) -> list[tuple]:
    """Rows of the same length."""
    width = max(map(len, rows), default=0)
    return [row + (None,) * (width - len(row)) for row in rows]


def _channel(cells: Sequence[Any]) -> tuple[str, Channel]:
    """Name and samples of a column: the texts above its first number are its name and its unit."""
    first = next((row for row, cell in enumerate(cells) if cell is not None and not isinstance(cell, str)), 0)
    texts = [cell.strip() for cell in cells[:first] if isinstance(cell, str)]
    unit = texts[1].strip("[]()") if len(texts) > 1 else ""
    values: Any = [
        float("nan") if cell in (None, "", "NA", "#N/A", "NaN") else cell for cell in cells[first:]
    ]
    header = texts[0] if texts else ""
    return header, Channel(values, unit or split_unit(header)[1])
