"""Variables of HDF5 (.h5, .hdf5) and netCDF (.nc, .nc4) by their paths, group/variable."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep.processes import apart
from wedgesweep.readers.extras import module
from wedgesweep.readers.table import Channel, Wanted


def hdf5(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Datasets, with the unit in their attribute ``units`` or ``unit``; in a process apart, as netCDF."""
    return apart(_hdf5, module("h5py"), file, wanted)


def _hdf5(h5py: Any, file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    with h5py.File(file, "r") as opened:
        names: list[str] = []
        opened.visititems(lambda name, each: names.append(name) if isinstance(each, h5py.Dataset) else None)
        return {
            name: _channel(opened[name]) if wanted(name, number) else None
            for number, name in enumerate(names, 1)
        }


def _channel(stored: Any) -> Channel:
    """A dataset; MATLAB writes the dimensions of its arrays in reverse."""
    unit = stored.attrs.get("units", stored.attrs.get("unit", ""))
    unit = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else str(unit)
    return Channel(np.transpose(stored[()]) if "MATLAB_class" in stored.attrs else stored[()], unit)


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
