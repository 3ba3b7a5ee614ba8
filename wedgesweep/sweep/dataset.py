"""The labelled dataset of a sweep: one table of every variable, and its netCDF encoding."""

import logging
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wedgesweep.errors import SweepError
from wedgesweep.files import regular, written
from wedgesweep.kinds import SWEEP, confusion
from wedgesweep.sweep.variables import FLAGS, GRID, REQUIRED, SCALED, Variable, variables_of

# xarray takes a third of a second to load, in which the processes that solve cases could already do so.
if TYPE_CHECKING:
    import xarray as xr

log = logging.getLogger(__name__)


def assemble(
    records: np.ndarray,
    coords: Mapping[str, Any],
    case_dims: Mapping[str, int],
    attrs: Mapping[str, Any],
    long_names: Mapping[str, str],
) -> "xr.Dataset":
    """Assemble the dataset from the records of all cases, in any order.

    ``case_dims``: names and sizes of the axes of the sweep; ``long_names``: of the variables that the system
    has.
    """
    import xarray as xr

    in_order = (records["index"][:-1] <= records["index"][1:]).all()
    ordered = records if in_order else records[np.argsort(records["index"])]
    variables = {}
    dims, shape = tuple(case_dims), tuple(case_dims.values())
    for variable in variables_of("scale" in dims):
        if variable.name not in (records.dtype.names or ()) or variable.name not in long_names:
            continue
        values = ordered[variable.name]
        if variable.dtype == "str":
            values = np.array([text.decode("utf-8", "replace") for text in values.tolist()], object)
        values = values.reshape(shape + values.shape[1:])
        about = _attributes(variable, long_names[variable.name])
        variables[variable.name] = (dims + variable.dims, values, about)
    return xr.Dataset(variables, coords, {"Conventions": "CF-1.13", **attrs})


def coordinates(case_coords: Mapping[str, Any], sizes: Mapping[str, int]) -> dict[str, Any]:
    """Return all coordinates: those of the cases (see ``assemble``) and those within a case."""
    if "time" in sizes:
        return dict(case_coords)
    coords = {
        **case_coords,
        "harmonic": ("harmonic", np.arange(1, sizes["harmonic"] + 1), {"long_name": "harmonic h"}),
        "part": ("part", ["real", "imaginary"], {"long_name": "part of the complex coefficient"}),
    }
    if sizes["phase"]:
        periods = sizes["phase"] / sizes["samples_per_period"]
        phase = 2.0 * np.pi * np.arange(sizes["phase"]) / sizes["samples_per_period"]
        about = f"phase omega t of the input over {periods:g} kept periods"
        coords["phase"] = ("phase", phase, {"units": "rad", "long_name": about})
    return coords


def _attributes(variable: Variable, long_name: str) -> dict[str, Any]:
    attributes: dict[str, Any] = {"long_name": long_name}
    if variable.units:
        attributes["units"] = variable.units
    if variable.name in FLAGS:
        attributes["flag_values"] = _flag_values(variable.name)
        attributes["flag_meanings"] = " ".join(FLAGS[variable.name][1])
    return attributes


def _flag_values(name: str) -> np.ndarray:
    """Values that a flag variable may have."""
    first, meanings = FLAGS[name]
    return np.arange(first, first + len(meanings), dtype=np.int8)


def journal_of(out: Path) -> Path:
    """Where the journal of an unfinished sweep is that will write a dataset."""
    return out.with_name(out.name + ".partial")


def write(dataset: "xr.Dataset", path: Path) -> None:
    """Write netCDF to a temporary file beside ``path``, and move it there when it is complete."""
    compressed = {"zlib": True, "complevel": 1, "shuffle": True}
    encoding: dict[str, dict[str, Any]] = {str(name): {"_FillValue": None} for name in dataset.coords}
    for name, variable in dataset.data_vars.items():
        # Compressing doubles saves a fifth of their size, and takes longer than solving the cases.
        if variable.dtype.kind in "fi" and variable.dtype != np.float64:
            encoding[str(name)] = compressed
    with written(path) as temporary:
        try:
            dataset.to_netcdf(temporary, engine="netcdf4", encoding=encoding)
        except (
            OSError,
            RuntimeError,
            ValueError,
        ) as error:  # netCDF4 raises any of them, without a file name
            raise SweepError(f"{path}: cannot be written ({_reason(error)}); is the disk full?") from error
    log.debug("%s: written, %d bytes", path, path.stat().st_size)


def read(path: Path) -> "xr.Dataset":
    """Load a dataset from a netCDF file; raises SweepError if there is none or it is damaged."""
    if problem := confusion(path, SWEEP):
        raise SweepError(problem)
    try:
        regular(path)
    except OSError as error:
        raise SweepError(f"{path}: {str(error.strerror).lower()}") from error
    import xarray as xr

    try:
        return xr.load_dataset(path, engine="netcdf4")
    except Exception as error:  # netCDF4 and the decoding of damaged content raise nearly anything
        raise SweepError(f"{path}: not a netCDF dataset, or damaged ({_reason(error)})") from error


def read_sweep(path: Path) -> "xr.Dataset":
    """Load the dataset of a sweep; raises SweepError, also if it lacks what every sweep has."""
    if path.is_file() and not path.stat().st_size:
        raise SweepError(f"{path}: empty file; run --fresh replaces it")
    found = read(path)
    if faults := list(_faults(found)):
        raise SweepError(f"{path}: not the dataset of a sweep: {'; '.join(faults)}")
    return found


def _faults(ds: "xr.Dataset") -> Iterator[str]:
    """What tells a dataset from that of a sweep: coordinates, dimensions, and the kinds of its variables."""
    if not isinstance(ds.attrs.get("config", ""), str):
        yield "its attribute config is no text"
    scaled = "scale" in ds.coords
    if not (scaled or isinstance(ds.attrs.get("omega_n"), float)):
        yield "its attribute omega_n is no number"
    coords = SCALED if scaled else (*GRID, "frequency")
    yield from (f"no coordinate {name}" for name in coords if name not in ds.coords)
    required = ("status", "message") if scaled else REQUIRED
    yield from (f"no variable {name}" for name in required if name not in ds)
    if "status" in ds and "friction_law" in ds.coords:
        known = {variable.name: variable for variable in variables_of(scaled)}
        yield from _shape_faults(ds, known, _case_dims(ds), coords)


def _case_dims(ds: "xr.Dataset") -> tuple[str, ...]:
    """The dimensions of the cases: those of the status that are coordinates, or a list or samples."""
    return tuple(str(dim) for dim in ds["status"].dims if dim in ds.coords or dim in ("case", "sample"))


def _shape_faults(
    ds: "xr.Dataset", known: Mapping[str, Variable], case_dims: tuple[str, ...], coords: tuple[str, ...]
) -> Iterator[str]:
    """What is wrong with dimensions and types of known variables and of coordinates."""
    for name in [each for each in ds.variables if each in known or each in coords]:
        found, variable = ds[name], known.get(str(name))
        dims = case_dims + variable.dims if variable else tuple(dim for dim in case_dims if dim in found.dims)
        if found.dims != dims:
            yield f"{name} has the dimensions {', '.join(map(str, found.dims))}, not {', '.join(dims)}"
        elif found.dtype.kind not in ("OUT" if _is_text(str(name), variable) else "bfiu"):
            yield f"{name} holds {found.dtype}"
        elif not found.size:
            yield f"{name} is empty"
        elif name in FLAGS and not np.isin(found, _flag_values(str(name))).all():
            yield f"{name} holds numbers without a meaning"


def _is_text(name: str, variable: Variable | None) -> bool:
    return variable.dtype == "str" if variable else name == "friction_law"


def _reason(error: Exception) -> str:
    """First line of an error's message."""
    return (str(error) or type(error).__name__).splitlines()[0]
