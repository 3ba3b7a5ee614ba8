"""export: a dataset as CSV, a row for each case."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from wedgesweep.cli.failure import Failure
from wedgesweep.cli.options import DATASET, STANDARD_OUTPUT, UNITS, OutputPath
from wedgesweep.cli.plot import read_dataset
from wedgesweep.files import CSV, written
from wedgesweep.formatting import counted
from wedgesweep.units import in_system

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr


# Units of coordinates where a dataset that passed through other hands does not state them.
STATED = {"frequency": "Hz", "amplitude": "m"}
COORDINATES = ("friction_law", "beta", "frequency", "amplitude", "scale")
# Dimensions of waveforms.
SAMPLED = ("phase", "time")
AS_CSV: dict[str, Any] = {"index": False, "lineterminator": "\n", "encoding": "utf-8"}


@click.command()
@DATASET
@click.option(
    "-o",
    "--output",
    type=OutputPath(CSV, allow_dash=True),
    help="CSV file to write, - to print; default: OUT's name with .csv, in the current directory.",
)
@click.option(
    "--variables",
    metavar="A,B,...",
    help="Variables to write, also the engineer's quantities of docs/api.md; default: all of OUT with one "
    "value a case.",
)
@UNITS
def export(path: Path, output: Path | None, variables: str | None, units: str) -> None:
    """Write the dataset OUT as CSV, a row for each case.

    The header states the units of the numbers. Cases that failed have their status and message, and no
    numbers. Cases that an unfinished run has not solved yet have the status not_run.
    """
    ds = read_dataset(path)
    chosen = None if variables is None else [name.strip() for name in variables.split(",") if name.strip()]
    if not {*(chosen or ())} <= set(ds.variables):
        ds = _with_quantities(ds, chosen or ())
    write_to = _table(in_system(ds, units), _variables_of(ds, chosen)).to_csv
    file = output or Path(f"{path.stem}.csv")
    if file == STANDARD_OUTPUT:
        click.echo(write_to(**AS_CSV), nl=False)
        return
    with written(file) as temporary:
        write_to(temporary, **AS_CSV)
    click.echo(f"wrote {file}: {counted(ds['status'].size, 'case')}")


def _with_quantities(ds: "xr.Dataset", names: Sequence[str]) -> "xr.Dataset":
    from wedgesweep import engineering_quantities

    try:
        return engineering_quantities.with_quantities(ds, names)
    except ValueError as error:
        raise Failure(str(error)) from error


def _variables_of(ds: "xr.Dataset", chosen: Sequence[str] | None) -> list[str]:
    """Names of the variables to write: those chosen, or all that are a number or word for each case.

    Raises Failure for one that is not there, or that holds a waveform.
    """
    dims = ds["status"].dims
    scalar = [str(name) for name in ds.data_vars if ds[name].dims == dims]
    if chosen is None:
        return scalar
    spectra = [str(name) for name in ds.data_vars if "harmonic" in ds[name].dims]
    for name in chosen:
        samples = [ds.sizes[dim] for dim in SAMPLED if name in ds.data_vars and dim in ds[name].dims]
        if samples:
            raise Failure(f"{name}: a waveform of {samples[0]} samples a case; read it with xarray")
        if name not in (*scalar, *spectra, *ds.coords):
            raise Failure(f"{name}: no such variable; valid here: {', '.join((*scalar, *spectra))}")
    return [name for name in dict.fromkeys(chosen) if name not in ds.coords]


def _table(ds: "xr.Dataset", variables: Sequence[str]) -> Any:
    """The table (pandas), a row for each case; numbers that are not there are empty.

    The first columns are the case: law, and beta, frequency and amplitude, or the scale of an input, and
    numbers of the model that the sweep varies. A column's name ends with its unit in brackets; the parts of a
    variable that has several a case are columns of their own.
    """
    import xarray as xr

    from wedgesweep.figures.models import varied

    names = [*(name for name in COORDINATES if name in ds.coords), *varied(ds)]
    columns = [column for name in (*names, *variables) for column in _columns(ds, name)]
    return xr.Dataset({header: ("row", values) for header, values in columns}).to_dataframe()


def _columns(ds: "xr.Dataset", name: str) -> "Iterator[tuple[str, np.ndarray]]":
    """Header and values, shape (cases,), of the columns of a variable."""
    dims = ds["status"].dims
    given = ds[name]
    unit = given.attrs.get("units", STATED.get(name, "1"))
    bracket = "" if unit in ("", "1") else f" [{unit}]"
    inner = [dim for dim in given.dims if dim not in dims]
    meanings = _meanings_of(given)
    whole = meanings if inner else meanings.broadcast_like(ds["status"])
    values = whole.transpose(*dims, *inner).values.reshape(ds["status"].size, -1)
    labels = [""]
    for dim in inner:
        labels = [f"{label}_{part}" for label in labels for part in ds[dim].values.tolist()]
    for label, column in zip(labels, values.T, strict=True):
        yield f"{name}{label}{bracket}", column


def _meanings_of(given: "xr.DataArray") -> "xr.DataArray":
    """Flags as the words that they stand for; other variables as they are."""
    if "flag_meanings" not in given.attrs:
        return given
    import numpy as np

    words = dict(zip(given.attrs["flag_values"].tolist(), given.attrs["flag_meanings"].split(), strict=True))
    return given.copy(data=np.vectorize(words.get, otypes=[object])(given.values))
