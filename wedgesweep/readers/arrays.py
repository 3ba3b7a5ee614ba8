"""Arrays of numpy (.npy, .npz), sound (.wav), variables of MATLAB (.mat), and JSON (.json, .jsonl)."""

import json
from collections.abc import Iterator, Mapping
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep.processes import apart
from wedgesweep.readers import hdf5
from wedgesweep.readers.table import Channel, Wanted, matrix_of, texts_of_columns, unit_and_name

HDF5_MARK = b"\x89HDF\r\n\x1a\n"
# A v7.3 file of MATLAB is HDF5 behind a header of this length.
MATLAB_HEADER = 512
# Greatest size of integer samples, so that full scale is 1; 8-bit samples are counted from 128.
FULL_SCALE = {
    "i": lambda dtype: -float(np.iinfo(dtype).min),
    "u": lambda dtype: 128.0,
    "f": lambda dtype: 1.0,
}


def npz(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Arrays by name; each is one channel, or a matrix of which ``name[2]`` is a column."""
    with file.open("rb") as stream, np.load(stream, allow_pickle=False) as opened:
        return {
            name: Channel(opened[name]) if wanted(name, number) else None
            for number, name in enumerate(opened.files, 1)
        }


def npy(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Columns of one array by number, or the fields of a structured one by name."""
    array = np.load(file, allow_pickle=False)
    if array.dtype.names:
        return {name: Channel(array[name]) for name in array.dtype.names}
    columns = array.reshape(array.shape[0], -1).T
    return {f"column {number}": Channel(column) for number, column in enumerate(columns, 1)}


def wav(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Tracks by number, with the clock of the file; full scale is 1."""
    from scipy.io import wavfile

    rate, samples = apart(wavfile.read, file)
    samples = samples[:, None] if samples.ndim == 1 else samples
    size = FULL_SCALE[samples.dtype.kind](samples.dtype)
    zero = 128.0 if samples.dtype.kind == "u" else 0.0
    clock = np.arange(len(samples)) / rate
    samples = np.where(np.isfinite(samples), samples, np.nan)
    return {
        f"track {number}": Channel((track - zero) / size, "", clock)
        for number, track in enumerate(samples.T, 1)
    }


def json_text(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Lists and numbers by the keys that lead to them, as a.b; a list of objects is one list for each key."""
    text = file.read_text("utf-8-sig")
    if file.suffix.lower() == ".jsonl":
        opened = [json.loads(line) for line in text.splitlines() if line.strip()]
    else:
        opened = json.loads(text)
    return {name or "list": Channel(_samples(each)) for name, each in _lists(opened)}


def _lists(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, list) and any(isinstance(each, dict) for each in value):
        rows = [each if isinstance(each, dict) else {} for each in value]
        value = {key: [each.get(key) for each in rows] for key in dict.fromkeys(chain(*rows))}
    if not isinstance(value, dict):
        yield path, value
        return
    for key, each in value.items():
        yield from _lists(each, f"{path}.{key}" if path else key)


def _samples(values: Any) -> np.ndarray:
    """Samples, NaN where null; what is no array of numbers stays as it is."""
    row = next((each for each in values if isinstance(each, list)), []) if isinstance(values, list) else []
    if row:
        values = [[None] * len(row) if each is None else each for each in values]
    try:
        return np.asarray(values, float)
    except (TypeError, ValueError, OverflowError):
        return np.asarray(values, object)


def matlab(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Variables, and fields of structs as struct.field."""
    with file.open("rb") as opened:
        beginning = opened.read(MATLAB_HEADER + len(HDF5_MARK))
    if beginning.startswith(HDF5_MARK) or beginning.endswith(HDF5_MARK):
        return hdf5.hdf5(file, wanted)
    return apart(_matlab_5, file, wanted)


def _matlab_5(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    from scipy.io import loadmat, whosmat

    classes = {name: kind for name, _, kind in whosmat(file)}
    names = [name for i, (name, kind) in enumerate(classes.items(), 1) if wanted(name, i) or kind == "struct"]
    found = dict(_fields(loadmat(file, variable_names=names)))
    listed: dict[str, Channel | None] = dict.fromkeys(classes)
    return listed | {name: each for name, each in found.items() if not name.startswith("__")}


def _fields(variables: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Channel]]:
    """Variables; fields of structs among them as struct.field, of arrays of structs as struct(2).field.

    Beside the samples a recorder's struct holds the name of a channel and its unit, or those of all columns.
    """
    words = {key: texts for key, value in variables.items() if path and (texts := _texts(value))}
    unit, label = unit_and_name({key: texts[0] for key, texts in words.items() if len(texts) == 1})
    for name, value in variables.items():
        columns = texts_of_columns(words, np.asarray(value)) if words else []
        for i, each in enumerate(columns):
            unit_of_column, its_label = unit_and_name(each)
            column = matrix_of(np.asarray(value))[:, i]
            yield f"{path}{name}[{i + 1}]", Channel(column, unit_of_column, label=its_label)
        if not columns:
            yield path + name, Channel(value, unit, label=label)
        if isinstance(value, np.ndarray) and value.dtype.names:
            for number, each in enumerate(value.ravel(), 1):
                place = f"{path}{name}." if value.size == 1 else f"{path}{name}({number})."
                yield from _fields({key: each[key] for key in value.dtype.names}, place)


def _texts(value: Any) -> list[str]:
    """A text, or those of a cell array; empty for anything else."""
    cells = value.ravel() if isinstance(value, np.ndarray) and value.dtype.kind == "O" else [value]
    known = [isinstance(each, np.ndarray) and each.dtype.kind == "U" and each.shape == (1,) for each in cells]
    return [str(each[0]) for each in cells] if all(known) else []
