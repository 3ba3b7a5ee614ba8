"""plot: figures of a dataset, of a diagnosis, or of measured data."""

import os
from contextlib import nullcontext
from math import isclose, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click
from click.core import ParameterSource

from wedgesweep import figures
from wedgesweep.cli.failure import Failure
from wedgesweep.cli.messages import log
from wedgesweep.cli.options import AT, DATASET, UNITS, FiniteRange, GivenPath, axis_values, require_place_for
from wedgesweep.figures import FORMATS, diagnosis, measured, samples, transient
from wedgesweep.kinds import is_measured
from wedgesweep.outcome import Outcome

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr

    from wedgesweep.figures import Data

ALL = "all"
# Figures by the data that they draw.
FAMILIES = {
    "For a dataset, KIND is one of": figures.FIGURES,
    "For a dataset of an [input], which does not repeat, lines, map or one of": transient.FIGURES,
    "For a dataset of samples ([sweep.sample] in its config), one of": samples.FIGURES,
    "For the directory of a diagnosis, one of": diagnosis.FIGURES,
    "For a measured.toml": measured.FIGURES,
}
KINDS = dict.fromkeys(name for family in FAMILIES.values() for name in family) | {ALL: None}
# What drawing raises where a part of a diagnosis is missing or of another kind.
DAMAGE = (LookupError, TypeError, AttributeError, AssertionError)
# So many values are listed one by one.
MOST_LISTED = 8
SUFFIXES = tuple(suffix[1:] for suffix in FORMATS)


def _paragraph(about: str, descriptions: dict[str, str]) -> str:
    """A paragraph of the help that keeps its lines."""
    return "\n".join(["\b", about, *(f"  {kind:<16} {text}" for kind, text in descriptions.items())])


HELP = "\n\n".join(
    [
        "Draw a figure of OUT: the dataset of a run, the directory of a diagnosis, or a measured.toml.",
        *(
            _paragraph(about, {name: kind.description for name, kind in family.items()})
            for about, family in FAMILIES.items()
        ),
        _paragraph("For all of them", {ALL: "every figure that suits OUT"}),
    ]
)

POSITIVE = FiniteRange(min=0.0, min_open=True)


@click.command(help=HELP, short_help="Draw a figure of a dataset, a diagnosis or measured data.")
@click.argument("kind", metavar="KIND", type=click.Choice(KINDS))
@DATASET
@click.option(
    "-o",
    "--output",
    type=GivenPath(),
    help=f"File ({', '.join(FORMATS)}), for 'all' a directory; default: beside the data.",
)
@click.option("--format", "suffix", type=click.Choice(SUFFIXES), default="png", show_default=True)
@click.option("--beta", type=POSITIVE, help="Frequency ratio; the nearest one in OUT is drawn.")
@click.option("--frequency", type=POSITIVE, metavar="HZ", help="Frequency in Hz, instead of --beta.")
@click.option(
    "--amplitude",
    type=POSITIVE,
    multiple=True,
    metavar="MM",
    help="Input amplitude in mm or rad (of a force in N); the nearest one in OUT is drawn; may be repeated.",
)
@click.option("--law", help="Friction law to draw; default: all.")
@click.option(
    "--x",
    metavar="AXIS",
    help="Axis along x: a dimension of OUT such as frequency, or a key such as "
    "suspension.wedge_angle_deg; map and lines draw over any.",
)
@click.option("--y", metavar="AXIS", help="Axis along y of a map.")
@click.option("--color", metavar="AXIS", help="Axis that is the colour of lines.")
@click.option("--facet", metavar="AXIS", help="Axis with a panel for each value.")
@click.option("--variable", metavar="NAME", help="Variable to draw, as in OUT.")
@AT
@UNITS
@click.pass_context
def plot(ctx: click.Context, kind: str, path: Path, output: Path | None, suffix: str, **picks: Any) -> None:
    """Draw a figure."""  # the text of --help is HELP
    if None not in (picks["beta"], picks["frequency"]):
        raise click.UsageError("give either --beta or --frequency")
    if kind == ALL:
        directory, found = output or _beside(path), _read(path)
        require_place_for(directory)
        directory.mkdir(parents=True, exist_ok=True)
        _draw_all(found, directory, suffix, _options(found, picks))
        return
    asked = ctx.get_parameter_source("suffix") is not ParameterSource.DEFAULT
    if output and asked and output.suffix.lower() != f".{suffix}":
        raise click.UsageError(f"--format {suffix} and -o {output} contradict each other; leave one out")
    file = output or _beside(path) / f"{kind}.{suffix}"
    _require_place(file)
    try:
        found = _read(path)
        _draw(kind, found, file, _options(found, picks))
    except ValueError as error:
        raise Failure(str(error)) from error


def _beside(path: Path) -> Path:
    return path if path.is_dir() else path.parent


def _read(path: Path) -> "Data":
    if path.suffix == ".toml" and is_measured(path):
        from wedgesweep.measured import read

        return read(path)
    from wedgesweep import diagnosis_result

    return diagnosis_result.read(path) if path.is_dir() else read_dataset(path)


def read_dataset(path: Path) -> "xr.Dataset":
    """Read the dataset of a run, also of one that has not finished."""
    from wedgesweep.sweep import dataset

    if not dataset.journal_of(path).exists():
        return dataset.read_sweep(path)
    from wedgesweep.sweep import unfinished

    found = unfinished.dataset_of(path)
    done = int((found["status"] != Outcome.NOT_RUN).sum())
    log.warning(f"{path}: unfinished; {done} of {found['status'].size} cases are there")
    return found


class Pick(NamedTuple):
    """An option that picks cases: the variable that it is of, and its unit, which is ``factor`` there."""

    variable: str
    factor: float
    unit: str


def _options(found: "Data", picks: dict[str, Any]) -> dict[str, Any]:
    """The picks that were given, in the units of the dataset; tell where it holds only their neighbours."""
    import xarray as xr

    given = {name: value for name, value in picks.items() if value not in (None, ())}
    if "at" in given:
        given["at"] = _values(found, given["at"])
    if not isinstance(found, xr.Dataset):
        return given
    forced = found.attrs.get("excitation") == "force"
    length = Pick("amplitude", 1.0, "rad") if found.attrs.get("motion") else Pick("amplitude", 1e-3, "mm")
    units = {
        "beta": Pick("beta", 1.0, ""),
        "frequency": Pick("beta", 2.0 * pi / found.attrs["omega_n"], "Hz"),
        "amplitude": Pick("amplitude", 1.0, "N") if forced else length,
    }
    for name in units.keys() & given.keys():
        pick, values = units[name], given.pop(name)
        if pick.variable not in found.coords:
            raise Failure(f"--{name}: the dataset has no {pick.variable}")
        several = isinstance(values, tuple)
        for value in values if several else (values,):
            _warn_unless_there(found, name, value, pick)
        given[pick.variable] = [value * pick.factor for value in values] if several else values * pick.factor
    return given


def _values(found: "Data", texts: tuple[str, ...]) -> dict[str, float | str]:
    """Values of axes out of texts such as "wedge_angle_deg=30", in the units of the dataset."""
    import xarray as xr

    values = axis_values(texts)
    forced = isinstance(found, xr.Dataset) and found.attrs.get("excitation") == "force"
    if isinstance(size := values.get("amplitude"), float) and not forced:
        values["amplitude"] = size * 1e-3
    return values


def _warn_unless_there(ds: "xr.Dataset", name: str, value: float, pick: Pick) -> None:
    """Say which value is taken for one that is not there, in its unit; refuse one that is far from all."""
    import numpy as np

    from wedgesweep.figures import cases

    there = np.atleast_1d(ds[pick.variable].values) / pick.factor
    nearest = there[np.abs(there - value).argmin()]
    if isclose(nearest, value, rel_tol=1e-6):
        return
    if abs(nearest - value) > cases.FAR * value:
        message = f"--{name} {value:.6g}: no case is near; the dataset has {_listed(np.unique(there))}"
        raise Failure(f"{message} {pick.unit}".rstrip())
    log.warning(f"--{name} {value:.6g}: the nearest one there is {nearest:.4g} {pick.unit}".rstrip())


def _listed(values: "np.ndarray") -> str:
    """The values, shape (n,), or the span of many."""
    if len(values) <= MOST_LISTED:
        return ", ".join(f"{each:.4g}" for each in values)
    return f"{len(values)} from {values[0]:.4g} to {values[-1]:.4g}"


def _require_place(file: Path) -> None:
    """Check before the drawing that the file can be written."""
    if file.suffix.lower() not in FORMATS:
        raise Failure(f"{file}: the suffix must be one of {', '.join(FORMATS)}")
    if not file.parent.is_dir() or not os.access(file.parent, os.W_OK):
        raise Failure(f"{file.parent}: not a directory that can be written to")


def _draw_all(found: "Data", directory: Path, suffix: str, options: dict[str, Any]) -> None:
    drawn = 0
    for kind in figures.of(found):
        try:
            _draw(kind, found, directory / f"{kind}.{suffix}", options, strict=False)
            drawn += 1
        except ValueError as error:
            log.info(f"skipped {error}")
    if not drawn:
        raise Failure("no figure suits this dataset")


def _draw(kind: str, found: "Data", file: Path, options: dict[str, Any], strict: bool = True) -> None:
    import numpy as np

    from wedgesweep.diagnosis_result import DiagnosisResult

    picks = _accepted(kind, figures.options(figures.kind_of(found, kind)), options, strict)
    # Numbers that no diagnosis writes end in an error below.
    of_diagnosis = isinstance(found, DiagnosisResult)
    handled = np.errstate(all="ignore") if of_diagnosis else nullcontext()
    try:
        with handled:
            figures.save(figures.draw(found, kind, **picks), file)
    except DAMAGE as error:
        if not of_diagnosis:  # whose content has been checked
            raise
        raise ValueError(
            f"{kind}: diagnosis.json or diagnosis.nc is not as a diagnosis writes it "
            f"({type(error).__name__}: {error})"
        ) from error
    click.echo(f"wrote {file}")


def _accepted(kind: str, names: tuple[str, ...], options: dict[str, Any], strict: bool) -> dict[str, Any]:
    """Select the options that the figure takes, by its names; another one is an error if strict."""
    accepted = {}
    for name, value in options.items():
        if name == "amplitude" and "amplitudes" in names:
            accepted["amplitudes"] = value
        elif name == "amplitude" and name in names:
            if len(value) > 1:
                raise ValueError(f"{kind}: takes a single --amplitude")
            accepted[name] = value[0]
        elif name in names:
            accepted[name] = value
        elif strict:
            asked = "--beta and no --frequency" if name == "beta" else f"--{name}"
            raise ValueError(f"{kind}: takes no {asked}")
    return accepted
