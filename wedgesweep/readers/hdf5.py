"""Variables of HDF5 (.h5, .hdf5) and netCDF (.nc, .nc4) by their paths, group/variable."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
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
        groups: dict[str, _Group] = {}
        sets: list[tuple[_Group, str]] = []

        def visit(path: str, each: Any) -> None:
            group, _, field = path.rpartition("/")
            if isinstance(each, h5py.Dataset) and each.shape is not None and not path.startswith(OF_MATLAB):
                sets.append((groups.setdefault(group, _Group(group, {})), field))
                groups[group].fields[field] = each

        opened.visititems(visit)
        listed = [each for group, field in sets for each in group.listed(field)]
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


@dataclass(frozen=True)
class _Group:
    """The datasets of a group by their names; of a struct of MATLAB, its fields."""

    path: str
    fields: dict[str, Any]

    @cached_property
    def words(self) -> dict[str, list[str]]:
        return _words(self.fields)

    @cached_property
    def structs(self) -> list[dict[str, Any]]:
        """The structs of an array, whose fields are datasets of references; empty if it is none."""
        referred = {name: _referred(each) for name, each in self.fields.items() if CLASS not in each.attrs}
        count = max(map(len, referred.values()), default=0)
        return [
            {name: each[i] for name, each in referred.items() if len(each) == count} for i in range(count)
        ]

    def listed(self, field: str) -> list[_Listed]:
        """Channels of a dataset; of a field of an array of structs, those of each struct."""
        stored = self.fields[field]
        path = f"{self.path}/{field}".removeprefix("/")
        if CLASS in stored.attrs:
            return _of_matlab(stored, path, self.words)
        if _refers(stored):
            fields = [
                (own, f"{self.path}({i}).{field}") for i, own in enumerate(self.structs, 1) if field in own
            ]
            return [each for own, name in fields for each in _of_matlab(own[field], name, _words(own))]
        items = self.fields.get(f"{field.removesuffix('_values')}_items")
        if items is None or not path.endswith("_values") or stored.shape[1:] != items.shape:
            return [_Listed(path, stored)]
        names = enumerate(map(_decoded, items[()]))
        return [_Listed(f"{self.path}/{name}", stored, (slice(None), i)) for i, name in names]


def _decoded(text: Any) -> str:
    return text.decode("utf-8", "replace") if isinstance(text, bytes) else str(text)


def _of_matlab(stored: Any, path: str, words: Mapping[str, list[str]]) -> list[_Listed]:
    """An array of a struct; or its columns, where a cell array beside it has a text for each."""
    if stored.dtype.kind not in "biuf" or EMPTY in stored.attrs or _texts(stored):
        return []
    if columns := texts_of_columns(words, np.broadcast_to(0.0, stored.shape[::-1])):
        return [
            _Listed(f"{path}[{i}]", stored, (..., i - 1), *unit_and_name(each))
            for i, each in enumerate(columns, 1)
        ]
    alone = {name: texts[0] for name, texts in words.items() if len(texts) == 1}
    return [_Listed(path, stored, ..., *unit_and_name(alone))]


def _refers(stored: Any) -> bool:
    return bool((stored.dtype.metadata or {}).get("ref"))


def _referred(stored: Any) -> list[Any]:
    """Datasets that one of references leads to."""
    found = [stored.file[each] for each in stored[()].ravel() if each] if _refers(stored) else []
    return [each for each in found if hasattr(each, "dtype")]


def _words(fields: Mapping[str, Any]) -> dict[str, list[str]]:
    """Texts by the names of the fields that hold them."""
    return {name: texts for name, each in fields.items() if (texts := _texts(each))}


def _texts(stored: Any) -> list[str]:
    """A text of MATLAB, or those of a cell array; empty for anything else."""
    texts = _referred(stored) if stored.attrs.get(CLASS) == b"cell" else [stored]
    return [_text(each) for each in texts] if all(each.attrs.get(CLASS) == b"char" for each in texts) else []


def _text(stored: Any) -> str:
    return "" if EMPTY in stored.attrs else "".join(map(chr, stored[()].ravel().tolist()))


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
