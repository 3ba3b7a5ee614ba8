"""Columns of a test from binary files: variables of MATLAB (.mat), HDF5 and Parquet files."""

import importlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep.csv_files.columns import NOTHING, Content
from wedgesweep.files import regular
from wedgesweep.hints import hint, show
from wedgesweep.processes import apart

HDF5_MARK = b"\x89HDF\r\n\x1a\n"
# A v7.3 file of MATLAB is HDF5 behind a header of this length.
MATLAB_HEADER = 512
# Module, and the extra that installs it.
EXTRAS = {"h5py": "hdf5", "pyarrow.parquet": "parquet"}

Reader = Callable[[Path, Mapping[str, str], list[str]], Content]


def reader(file: Path) -> Reader | None:
    """The reader of a binary file, by its suffix; None for text."""
    variables = READERS.get(file.suffix.lower())
    return None if variables is None else lambda *given: _read(variables, *given)


def _read(
    variables: Callable[[Path, list[str]], Mapping[str, Any]],
    file: Path,
    wanted: Mapping[str, str],
    problems: list[str],
) -> Content:
    """Read the wanted variables; faults are appended to ``problems``, and the result is then empty."""
    try:
        found = variables(regular(file), list(wanted.values()))
    except OSError as error:
        problems.append(f"{file}: {error.strerror or error}; give the path of a data file")
        return NOTHING
    except Exception as error:  # the libraries raise nearly anything for damaged files
        problems.append(f"{file}: cannot be read ({(str(error) or type(error).__name__).splitlines()[0]})")
        return NOTHING
    found = {name: each for name, each in found.items() if not name.startswith("__")}
    faults = [
        f"no variable {show(name)}; {hint(name, found)}" for name in wanted.values() if name not in found
    ]
    columns = {}
    for channel, name in wanted.items():
        if name in found:
            columns[channel], wrong = _numbers(found[name])
            faults.extend(f"variable {show(name)} {each}" for each in wrong)
    if not faults and len({numbers.size for numbers in columns.values()}) > 1:
        sizes = ", ".join(f"{wanted[channel]} {numbers.size}" for channel, numbers in columns.items())
        faults.append(f"variables of different numbers of samples: {sizes}")
    problems.extend(f"{file}: {fault}" for fault in faults)
    if faults:
        return NOTHING
    form = f"{file.suffix.lower().lstrip('.')} file"
    return Content(columns, np.arange(columns["time"].size), form=form)


def _numbers(values: Any) -> tuple[np.ndarray, list[str]]:
    """A list, row or column of real numbers as floats, shape (n,), and its faults."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiu" or not array.size:
        return np.zeros(0), ["is no list of real numbers"]
    if max(array.shape, default=0) != array.size:
        shape = " x ".join(map(str, array.shape))
        return np.zeros(0), [f"holds {shape} numbers; store each channel as a variable of its own"]
    numbers = array.ravel().astype(float)
    wrong = np.flatnonzero(~np.isfinite(numbers))
    return numbers, [f"has no finite number at sample {wrong[0]}"] if wrong.size else []


def _matlab(file: Path, names: list[str]) -> Mapping[str, Any]:
    with file.open("rb") as opened:
        beginning = opened.read(MATLAB_HEADER + len(HDF5_MARK))
    if beginning.startswith(HDF5_MARK) or beginning.endswith(HDF5_MARK):
        return _hdf5(file, names)
    return apart(_matlab_5, file, names)


def _matlab_5(file: Path, names: list[str]) -> Mapping[str, Any]:
    from scipy.io import loadmat, whosmat

    classes = {name: kind for name, _, kind in whosmat(file)}
    wanted = [name for name, kind in classes.items() if name in names or kind == "struct"]
    return dict.fromkeys(classes) | dict(_fields(loadmat(file, variable_names=wanted)))


def _fields(variables: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Any]]:
    """Variables, and the fields of structs among them as struct.field."""
    for name, value in variables.items():
        yield path + name, value
        if isinstance(value, np.ndarray) and value.dtype.names and value.size == 1:
            yield from _fields({each: value[each].item() for each in value.dtype.names}, f"{path}{name}.")


def _hdf5(file: Path, names: list[str]) -> Mapping[str, Any]:
    """Variables by their paths; a dot will do for a slash, as structs of MATLAB are groups."""
    with _module("h5py").File(file, "r") as opened:
        there: list[str] = []
        opened.visit(there.append)
        found = {name: opened[name] for name in there}
        found |= {name: found[name.replace(".", "/")] for name in names if name.replace(".", "/") in found}
        return {name: each[()] if name in names else None for name, each in found.items()}


def _parquet(file: Path, names: list[str]) -> Mapping[str, Any]:
    parquet = _module("pyarrow.parquet")
    there = parquet.read_schema(file).names
    table = parquet.read_table(file, columns=[name for name in names if name in there])
    return dict.fromkeys(there) | {name: table[name].to_numpy() for name in table.column_names}


def _module(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        message = f"needs {name.partition('.')[0]}: pip install 'wedgesweep[{EXTRAS[name]}]'"
        raise OSError(message) from error


READERS = {".mat": _matlab, ".h5": _hdf5, ".hdf5": _hdf5, ".parquet": _parquet}
