"""Reads files of many formats: each reader turns one into named channels, with unit and clock."""

import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from wedgesweep.files import regular
from wedgesweep.readers import arrays, hdf5, recorders, tables, text
from wedgesweep.readers.table import Channel, Name, ReadError, Table, Wanted

__all__ = ["READERS", "ReadError", "Table", "read"]

# Readers of the variables of binary files by ending; everything else is text.
READERS: dict[str, Callable[[Path, Wanted], Mapping[str, Channel | None]]] = {
    ".npy": arrays.npy,
    ".npz": arrays.npz,
    ".wav": arrays.wav,
    ".json": arrays.json_text,
    ".jsonl": arrays.json_text,
    ".mat": arrays.matlab,
    ".h5": hdf5.hdf5,
    ".hdf5": hdf5.hdf5,
    ".nc": hdf5.netcdf,
    ".nc4": hdf5.netcdf,
    ".parquet": tables.parquet,
    ".xlsx": tables.xlsx,
    ".tdms": recorders.tdms,
    ".uff": recorders.uff,
    ".unv": recorders.uff,
    ".mf4": recorders.mdf,
}


def read(path: Path, names: Sequence[Name], stated: Mapping[str, Any] | None = None) -> Table:
    """Read channels by their names or numbers; ``stated`` is the table measurement.csv.

    Raises ReadError, whose problems name the file.
    """
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        return text.read(path, names, stated)
    wanted = Wanted(tuple(names))
    channels = stored(path, lambda: wanted.picked(reader(regular(path), wanted)))
    return Table(
        channels, lambda sample: f"{path}: sample {sample}", f"{path.suffix.lower().lstrip('.')} file"
    )


def stored(path: Path, reading: Callable[[], Any]) -> Any:
    """What a binary file holds; raises ReadError for all that its library may raise.

    Of a damaged file it may warn as well, which a reader has no use for.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return reading()
    except ReadError as error:
        raise ReadError([f"{path}: {problem}" for problem in error.problems]) from error
    except OSError as error:
        raise ReadError([f"{path}: {error.strerror or error}; give the path of a data file"]) from error
    except Exception as error:  # the libraries raise nearly anything for damaged files
        reason = (str(error) or type(error).__name__).splitlines()[0]
        raise ReadError([f"{path}: cannot be read ({reason})"]) from error
