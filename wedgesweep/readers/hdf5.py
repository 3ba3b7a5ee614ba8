"""Variables of HDF5 (.h5, .hdf5) and netCDF (.nc, .nc4) by their paths, group/variable."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from wedgesweep.processes import apart
from wedgesweep.readers.extras import module
from wedgesweep.readers.table import Channel, Wanted, matrix_of, texts_of_columns, unit_and_name

# Attributes in which MATLAB says what a dataset is and that it is empty, and groups of what others refer to.
CLASS, EMPTY, OF_MATLAB = "MATLAB_class", "MATLAB_empty", ("#refs#", "#subsystem#")


def hdf5(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Datasets, with the unit in their attribute ``units`` or ``unit``; in a process apart, as netCDF."""
    return apart(_hdf5, module("h5py"), file, wanted)


def _hdf5(h5py: Any, file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    with h5py.File(file, "r") as opened:
        sets: list[Any] = []
        opened.visititems(lambda _, each: sets.append(each) if isinstance(each, h5py.Dataset) else None)
        listed = [each for stored in sets for each in _listed(stored)]
        return {
            each.name: each.channel() if wanted(each.name, number) else None
            for number, each in enumerate(listed, 1)
        }


class _Listed(NamedTuple):
    """A dataset or a column of it, by its name, with the unit and the label that stand beside it."""

    name: str
    stored: Any
    column: Any = ...
    unit: str = ""
    label: str = ""

    def channel(self) -> Channel:
        """The samples; MATLAB writes the dimensions of its arrays in reverse."""
        attributes, unit = self.stored.attrs, self.unit
        unit = unit or _decoded(attributes.get("units", attributes.get("unit", "")))
        values = self.stored[()]
        if CLASS in attributes:
            values = np.transpose(values) if self.column is ... else matrix_of(np.transpose(values))
        return Channel(values if self.column is ... else values[self.column], unit, label=self.label)


def _listed(stored: Any) -> list[_Listed]:
    """Channels of a dataset; of a field of an array of structs of MATLAB, those of each struct."""
    path = stored.name.removeprefix("/")
    if stored.shape is None or path.startswith(OF_MATLAB):
        return []
    group, _, field = path.rpartition("/")
    if structs := _structs(stored):
        fields = [(own, f"{group}({i}).{field}") for i, own in enumerate(structs, 1)]
        return [each for own, name in fields for each in _of_matlab(own[field], name, own)]
    if CLASS in stored.attrs:
        return _of_matlab(stored, path, stored.parent)
    items = stored.parent.get(f"{field.removesuffix('_values')}_items")
    if items is None or not path.endswith("_values") or stored.shape[1:] != items.shape:
        return [_Listed(path, stored)]
    names = enumerate(map(_decoded, items[()]))
    return [_Listed(f"{group}/{name}", stored, (slice(None), i)) for i, name in names]


def _decoded(text: Any) -> str:
    return text.decode("utf-8", "replace") if isinstance(text, bytes) else str(text)


def _of_matlab(stored: Any, path: str, beside: Mapping[str, Any]) -> list[_Listed]:
    """An array of a struct; or its columns, where a cell array beside it has a text for each."""
    kind = stored.dtype.kind if hasattr(stored, "dtype") else ""
    if not kind or kind not in "biuf" or EMPTY in stored.attrs or _texts(stored):
        return []
    words = {name: texts for name, each in beside.items() if (texts := _texts(each))}
    if columns := texts_of_columns(words, np.broadcast_to(0.0, stored.shape[::-1])):
        return [
            _Listed(f"{path}[{i}]", stored, (..., i - 1), *unit_and_name(each))
            for i, each in enumerate(columns, 1)
        ]
    alone = {name: texts[0] for name, texts in words.items() if len(texts) == 1}
    return [_Listed(path, stored, ..., *unit_and_name(alone))]


def _structs(stored: Any) -> list[dict[str, Any]]:
    """The structs of an array, a field of which is a dataset of references; empty if it is none."""
    count = 0 if CLASS in stored.attrs else len(_referred(stored))
    beside = stored.parent.items() if count else ()
    fields = {name: _referred(each) for name, each in beside if hasattr(each, "dtype")}
    return [{name: each[i] for name, each in fields.items() if len(each) == count} for i in range(count)]


def _referred(stored: Any) -> list[Any]:
    """What a dataset of references leads to."""
    if not (stored.dtype.metadata or {}).get("ref"):
        return []
    return [stored.file[each] for each in stored[()].ravel() if each]


def _texts(stored: Any) -> list[str]:
    """A text of MATLAB, or those of a cell array; empty for anything else."""
    kind = stored.attrs.get(CLASS)
    if kind == b"char":
        return ["" if EMPTY in stored.attrs else "".join(map(chr, stored[()].ravel().tolist()))]
    cells = [_texts(each) for each in _referred(stored)] if kind == b"cell" else []
    return [text for texts in cells for text in texts] if all(len(texts) == 1 for texts in cells) else []


def netcdf(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Variables in a process apart: its library may end the process that reads a damaged file."""
    return apart(_netcdf, file, wanted)


def _netcdf(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    import netCDF4

    with netCDF4.Dataset(file) as root:
        return {
            name: Channel(variable[...], str(getattr(variable, "units", "")))
            if wanted(name, number)
            else None
            for number, (name, variable) in enumerate(_variables(root), 1)
        }


def _variables(group: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    for name, variable in group.variables.items():
        yield path + name, variable
    for name, inner in group.groups.items():
        yield from _variables(inner, f"{path}{name}/")
