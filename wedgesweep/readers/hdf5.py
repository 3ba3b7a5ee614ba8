"""Variables of HDF5 (.h5, .hdf5) and netCDF (.nc, .nc4) by their paths, group/variable."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep.processes import apart
from wedgesweep.readers.extras import module
from wedgesweep.readers.table import Channel, Wanted, unit_and_name

# The attribute in which MATLAB says what a dataset is.
CLASS = "MATLAB_class"


def hdf5(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Datasets, with the unit in their attribute ``units`` or ``unit``; in a process apart, as netCDF."""
    return apart(_hdf5, module("h5py"), file, wanted)


def _hdf5(h5py: Any, file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    with h5py.File(file, "r") as opened:
        sets: list[Any] = []
        opened.visititems(lambda _, each: sets.append(each) if isinstance(each, h5py.Dataset) else None)
        sets = [each for each in sets if not _word(each)]
        listed = [(name, each, column) for each in sets for name, column in _columns(each)]
        return {
            name: _channel(stored, column) if wanted(name, number) else None
            for number, (name, stored, column) in enumerate(listed, 1)
        }


def _columns(stored: Any) -> list[tuple[str, Any]]:
    """Name of a dataset; or names and columns of a block of pandas, which lists the names beside it."""
    path = stored.name.removeprefix("/")
    items = stored.parent.get(f"{path.rpartition('/')[2].removesuffix('_values')}_items")
    if items is None or not path.endswith("_values") or stored.shape[1:] != items.shape:
        return [(path, ...)]
    names = [each.decode("utf-8", "replace") if isinstance(each, bytes) else str(each) for each in items[()]]
    return [(f"{path.rpartition('/')[0]}/{name}", (slice(None), i)) for i, name in enumerate(names)]


def _channel(stored: Any, column: Any) -> Channel:
    """A dataset or a column of it; MATLAB writes the dimensions of its arrays in reverse."""
    unit = stored.attrs.get("units", stored.attrs.get("unit", ""))
    unit = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else str(unit)
    if CLASS not in stored.attrs:
        return Channel(stored[()] if column is ... else stored[()][column], unit)
    unit, label = unit_and_name({name: word for name, each in stored.parent.items() if (word := _word(each))})
    return Channel(np.transpose(stored[()]), unit, label=label)


def _word(stored: Any) -> str:
    """The text of MATLAB's characters; empty for anything else."""
    if stored.attrs.get(CLASS) != b"char":
        return ""
    return "".join(map(chr, stored[()].ravel().tolist()))


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
