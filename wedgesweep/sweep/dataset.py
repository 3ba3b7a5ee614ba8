"""The labelled dataset of a sweep: one table of every variable, and its netCDF encoding."""

import logging
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from wedgesweep.errors import SweepError
from wedgesweep.files import regular, written
from wedgesweep.kinds import SWEEP, confusion
from wedgesweep.outcome import Outcome

# xarray takes a third of a second to load, in which the processes that solve cases could already do so.
if TYPE_CHECKING:
    import xarray as xr

log = logging.getLogger(__name__)

STATUSES = tuple(map(str, Outcome))
HARMONICS = 9


@dataclass(frozen=True)
class Variable:
    """A variable of the dataset; ``dims`` follow the case dimensions."""

    name: str
    units: str
    long_name: str
    dims: tuple[str, ...] = ()
    dtype: str = "f8"


PHASE = ("phase",)
SPECTRUM = ("harmonic", "part")

VARIABLES = (
    Variable("amplitude_ratio", "1", "half peak-to-peak of x - y over the input amplitude"),
    Variable("peak_to_peak", "m", "peak-to-peak of the relative displacement x - y"),
    Variable("peak_velocity", "m s-1", "largest magnitude of the relative velocity x' - y'"),
    Variable("mean_displacement", "m", "mean of x - y from its value at the frictionless rest position"),
    Variable(
        "stick_fraction",
        "1",
        "share of time stuck (coulomb) or with the column face below the threshold velocity",
    ),
    Variable("stick_phases", "1", "number of sticking phases per forcing period"),
    Variable("displacement_harmonics", "m", "D_h of x - y = Re sum D_h exp(i h omega t)", SPECTRUM),
    Variable("velocity_harmonics", "m s-1", "V_h of x' - y' = Re sum V_h exp(i h omega t)", SPECTRUM),
    Variable("phase_lag", "rad", "lag of the fundamental of x - y behind the input u"),
    Variable("dissipated_energy", "J", "energy dissipated by friction and dampers per forcing period"),
    Variable("supplied_energy", "J", "energy supplied by the base per forcing period"),
    Variable("minimum_normal_force", "N", "smallest normal force of either face while slipping"),
    Variable("lift_off_fraction", "1", "share of the slipping time with a negative normal force"),
    Variable(
        "periodicity",
        "1",
        "largest change of x - y from the last period but one to the last, over input amplitude",
    ),
    Variable(
        "period",
        "1",
        "period of the response in forcing periods; 0: it did not repeat, -1: not looked for",
        dtype="i2",
    ),
    Variable("settled_periods", "1", "forcing periods run before the kept ones", dtype="i8"),
    Variable("status", "1", "outcome of the case", dtype="i1"),
    Variable("message", "", "reason of a failure, empty otherwise", dtype="str"),
    Variable("rate_evaluations", "1", "calls of the right-hand side", dtype="i8"),
    Variable("steps", "1", "steps of the integrator", dtype="i8"),
    Variable("switches", "1", "located switches between slip branches", dtype="i8"),
    Variable("wall_time", "s", "wall time of the case"),
    Variable(
        "displacement",
        "m",
        "relative displacement x - y (side frame minus bolster) from frictionless rest",
        PHASE,
        "f4",
    ),
    Variable("velocity", "m s-1", "relative velocity x' - y'", PHASE, "f4"),
    Variable("normal_force_column", "N", "normal force on the column face", PHASE, "f4"),
    Variable("normal_force_bolster", "N", "normal force on the bolster face", PHASE, "f4"),
    Variable("stuck", "1", "1 where stuck, as counted by stick_fraction", PHASE, "i1"),
)

WAVEFORMS = tuple(variable.name for variable in VARIABLES if variable.dims == PHASE)

# Additional variables of unilateral joints.
OF_LIFT_OFF = (
    Variable("column_open_fraction", "1", "share of time with the column contact open"),
    Variable("bolster_open_fraction", "1", "share of time with the bolster contact open"),
    Variable("impacts", "1", "impacts of a wedge per forcing period"),
    Variable("largest_impulse", "N s", "largest normal impulse of an impact, on one wedge"),
    Variable("impact_energy", "J", "energy lost in impacts per forcing period, beside dissipated_energy"),
)

# Within a case of a motion that does not repeat.
TIME = ("time",)
_SHARED = ("status", "message", "rate_evaluations", "steps", "switches", "wall_time")
_NAMED = {variable.name: variable for variable in VARIABLES}
# Variables of a dataset whose input does not repeat, after those that are the same.
TRANSIENT = (
    Variable("peak_displacement", "m", "largest magnitude of x - y"),
    Variable("peak_to_peak", "m", "peak-to-peak of x - y"),
    Variable("peak_velocity", "m s-1", "largest magnitude of x' - y'"),
    Variable("mean_displacement", "m", "mean of x - y from its value at the frictionless rest position"),
    Variable("rms_displacement", "m", "rms of the stored samples of x - y"),
    _NAMED["stick_fraction"],
    Variable("dissipated_energy", "J", "energy dissipated by friction and dampers in all"),
    Variable("supplied_energy", "J", "energy supplied by the base in all"),
    _NAMED["minimum_normal_force"],
    _NAMED["lift_off_fraction"],
    *(_NAMED[name] for name in _SHARED),
    Variable("displacement", "m", _NAMED["displacement"].long_name, TIME),
    Variable("velocity", "m s-1", "relative velocity x' - y'", TIME),
    Variable("acceleration", "m s-2", "relative acceleration x'' - y''", TIME),
    Variable("force", "N", "force that springs, dampers and friction set against x - y", TIME),
    Variable("normal_force_column", "N", "normal force on the column face", TIME, "f4"),
    Variable("normal_force_bolster", "N", "normal force on the bolster face", TIME, "f4"),
    Variable("stuck", "1", "1 where stuck, as counted by stick_fraction", TIME, "i1"),
)

# Additional variables of a continuation; all others belong to its sweep up in beta. Two responses are
# distinct if their amplitude ratios differ by more than DISTINCT times steady_tolerance, or their periods.
DISTINCT = 1000.0
CONTINUED = (
    Variable("amplitude_ratio_down", "1", "amplitude_ratio on the way down in beta"),
    Variable("period_down", "1", "period on the way down in beta", dtype="i2"),
    Variable(
        "coexisting",
        "1",
        "whether the ways up and down in beta end in different responses: periods differ, or amplitude "
        f"ratios by more than {DISTINCT:g} steady_tolerance; not told where one did not repeat or failed",
        dtype="i1",
    ),
)
# Flag variables: first value, and the meanings of the values from there on.
FLAGS = {"status": (0, STATUSES), "coexisting": (-1, ("not_told", "no", "yes"))}

GRID = ("friction_law", "beta", "amplitude")
# Case dimensions where the input does not repeat.
SCALED = ("friction_law", "scale")
REQUIRED = ("status", "message", "period", "periodicity")
MESSAGE_BYTES = 200


def record_dtype(sizes: Mapping[str, int], continued: bool = False) -> np.dtype:
    """Layout of the record of a case: its index and every variable, with dimensions from ``sizes``.

    Without samples (``sizes`` of "phase" or "time" 0) there are no waveforms; ``continued`` adds CONTINUED.
    """
    fields: list[tuple[Any, ...]] = [("index", "i8")]
    for variable in TRANSIENT if "time" in sizes else VARIABLES + OF_LIFT_OFF + CONTINUED * continued:
        if variable.dims in (PHASE, TIME) and not sizes[variable.dims[0]]:
            continue
        dtype = f"S{MESSAGE_BYTES}" if variable.dtype == "str" else variable.dtype
        fields.append((variable.name, dtype, tuple(sizes[dim] for dim in variable.dims)))
    return np.dtype(fields)


def blank(dtype: np.dtype, indices: np.ndarray) -> np.ndarray:
    """Records of cases without results: NaN, zero counts, status not_run."""
    records = np.zeros(len(indices), dtype)
    for name in dtype.names or ():
        if dtype[name].base.kind == "f":
            records[name] = np.nan
    records["index"] = indices
    for name in {"period", "period_down", "coexisting"} & set(dtype.names or ()):
        records[name] = -1
    records["status"] = Outcome.NOT_RUN
    return records


def assemble(
    records: np.ndarray,
    coords: Mapping[str, Any],
    shape: tuple[int, ...],
    attrs: Mapping[str, Any],
    long_names: Mapping[str, str | None] = MappingProxyType({}),
) -> "xr.Dataset":
    """Assemble the dataset from the records of all cases, in any order.

    ``shape`` holds the sizes of the case dimensions: three for a grid (friction_law, beta, amplitude), two
    where the input does not repeat (friction_law, scale), one for a list (case). ``long_names``: those of
    another system, by variable; None: it does not have it.
    """
    import xarray as xr

    case_dims: tuple[str, ...] = {3: GRID, 2: SCALED, 1: ("case",)}[len(shape)]
    in_order = (records["index"][:-1] <= records["index"][1:]).all()
    ordered = records if in_order else records[np.argsort(records["index"])]
    variables = {}
    for variable in TRANSIENT if case_dims == SCALED else VARIABLES + OF_LIFT_OFF + CONTINUED:
        long_name = long_names.get(variable.name, variable.long_name)
        if variable.name not in (records.dtype.names or ()) or long_name is None:
            continue
        values = ordered[variable.name]
        if variable.dtype == "str":
            values = np.array([text.decode("utf-8", "replace") for text in values.tolist()], object)
        values = values.reshape(shape + values.shape[1:])
        variables[variable.name] = (case_dims + variable.dims, values, _attributes(variable, long_name))
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
            message = f"{path}: cannot be written ({_reason(error)}); is the disk full?"
            raise SweepError(message) from error
    log.debug("%s: written, %d bytes", path, path.stat().st_size)


def read(path: Path) -> "xr.Dataset":
    """Load a dataset from a netCDF file; raises SweepError if there is none or it is damaged."""
    import xarray as xr

    if problem := confusion(path, SWEEP):
        raise SweepError(problem)
    try:
        regular(path)
    except OSError as error:
        message = f"{path}: {str(error.strerror).lower()}"
        raise SweepError(message) from error
    try:
        return xr.load_dataset(path, engine="netcdf4")
    except Exception as error:  # netCDF4 and the decoding of damaged content raise nearly anything
        message = f"{path}: not a netCDF dataset, or damaged ({_reason(error)})"
        raise SweepError(message) from error


def read_sweep(path: Path) -> "xr.Dataset":
    """Load the dataset of a sweep; raises SweepError, also if it lacks what every sweep has."""
    found = read(path)
    if faults := list(_faults(found)):
        message = f"{path}: not the dataset of a sweep: {'; '.join(faults)}"
        raise SweepError(message)
    return found


def _faults(ds: "xr.Dataset") -> Iterator[str]:
    """What tells a dataset from that of a sweep: coordinates, dimensions, and the kinds of its variables."""
    if "scale" in ds.coords:
        yield from (f"no coordinate {name}" for name in SCALED if name not in ds.coords)
        yield from (f"no variable {name}" for name in ("status", "message") if name not in ds)
        known = {variable.name: variable for variable in TRANSIENT}
        yield from _shape_faults(ds, known, SCALED, SCALED)
        return
    yield from (f"no coordinate {name}" for name in (*GRID, "frequency") if name not in ds.coords)
    yield from (f"no variable {name}" for name in REQUIRED if name not in ds)
    if "beta" not in ds.coords:
        return
    case_dims = ("case",) if ds["beta"].dims == ("case",) else GRID
    known = {variable.name: variable for variable in VARIABLES + OF_LIFT_OFF + CONTINUED}
    yield from _shape_faults(ds, known, case_dims, (*GRID, "frequency"))


def _shape_faults(
    ds: "xr.Dataset", known: Mapping[str, Variable], case_dims: tuple[str, ...], coords: tuple[str, ...]
) -> Iterator[str]:
    """What is wrong with dimensions and types of known variables and of coordinates."""
    for name in [each for each in ds.variables if each in known or each in coords]:
        found = ds[name]
        dims, kinds = _expected(str(name), known.get(str(name)), case_dims)
        if found.dims != dims:
            yield f"{name} has the dimensions {', '.join(map(str, found.dims))}, not {', '.join(dims)}"
        elif found.dtype.kind not in kinds:
            yield f"{name} holds {found.dtype}"
        elif not found.size:
            yield f"{name} is empty"
        elif (
            name in FLAGS
            and not np.isin(found, FLAGS[str(name)][0] + np.arange(len(FLAGS[str(name)][1]))).all()
        ):
            yield f"{name} holds numbers without a meaning"


def _expected(
    name: str, variable: Variable | None, case_dims: tuple[str, ...]
) -> tuple[tuple[str, ...], str]:
    """Dimensions of a variable or coordinate, and the kinds of numpy types that it may have."""
    if variable is None:
        own = {"frequency": "beta"}.get(name, name)
        return (own if len(case_dims) > 1 else "case",), "OUT" if name == "friction_law" else "bfiu"
    return case_dims + variable.dims, "OUT" if variable.dtype == "str" else "bfiu"


def _reason(error: Exception) -> str:
    """First line of an error's message."""
    return (str(error) or type(error).__name__).splitlines()[0]
