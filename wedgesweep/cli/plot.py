"""plot: figures of a dataset, or of a diagnosis."""

import os
from math import isclose, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from wedgesweep import figures
from wedgesweep.cli.failure import Failure
from wedgesweep.cli.messages import log
from wedgesweep.cli.options import DATASET
from wedgesweep.figures import DESCRIPTIONS, FORMATS, diagnosis
from wedgesweep.outcome import Outcome

if TYPE_CHECKING:
    import xarray as xr

    from wedgesweep.diagnosis_result import DiagnosisResult

ALL = "all"
# What drawing raises where a part of a diagnosis is missing or of another kind.
DAMAGE = (LookupError, TypeError, AttributeError, AssertionError)
SUFFIXES = tuple(suffix[1:] for suffix in FORMATS)


def _table(descriptions: dict[str, str]) -> str:
    return "\n".join(f"  {kind:<16} {text}" for kind, text in descriptions.items())


HELP = f"""Draw a figure of OUT: the dataset of a run, or the directory of a diagnosis.

\b
For a dataset, KIND is one of
{_table(DESCRIPTIONS)}

\b
For the directory of a diagnosis, one of
{_table(diagnosis.DESCRIPTIONS)}

\b
For both
  {ALL:<16} every figure that suits OUT
"""

POSITIVE = click.FloatRange(min=0.0, min_open=True)


@click.command(help=HELP, short_help="Draw a figure of a dataset or a diagnosis.")
@click.argument("kind", metavar="KIND", type=click.Choice([*DESCRIPTIONS, *diagnosis.DESCRIPTIONS, ALL]))
@DATASET
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
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
    help="Input amplitude in mm; the nearest one in OUT is drawn; may be repeated.",
)
@click.option("--law", help="Friction law to draw; default: all.")
@click.pass_context
def plot(
    ctx: click.Context,
    kind: str,
    path: Path,
    output: Path | None,
    suffix: str,
    **picks: Any,
) -> None:
    """Draw a figure."""  # the text of --help is HELP
    if None not in (picks["beta"], picks["frequency"]):
        message = "give either --beta or --frequency"
        raise click.UsageError(message)
    if kind == ALL:
        directory, found = output or _beside(path), _read(path)
        directory.mkdir(parents=True, exist_ok=True)
        _draw_all(found, directory, suffix, _options(found, picks))
        return
    _require_kind(kind, path)
    asked = ctx.get_parameter_source("suffix") is not ParameterSource.DEFAULT
    if output and asked and output.suffix.lower() != f".{suffix}":
        message = f"--format {suffix} and -o {output} contradict each other; leave one out"
        raise click.UsageError(message)
    file = output or _beside(path) / f"{kind}.{suffix}"
    _require_place(file)
    try:
        found = _read(path)
        _draw(kind, found, file, _options(found, picks))
    except ValueError as error:
        raise Failure(str(error)) from error


def _beside(path: Path) -> Path:
    return path if path.is_dir() else path.parent


def _read(path: Path) -> "xr.Dataset | DiagnosisResult":
    from wedgesweep import diagnosis_result
    from wedgesweep.sweep import dataset, run

    if path.is_dir():
        return diagnosis_result.read(path)
    unfinished = run.unfinished(path)
    if unfinished is None:
        return dataset.read_sweep(path)
    done = int((unfinished["status"] != Outcome.NOT_RUN).sum())
    log.warning(f"{path}: unfinished; {done} of {unfinished['status'].size} cases are drawn")
    return unfinished


def _options(found: "xr.Dataset | DiagnosisResult", picks: dict[str, Any]) -> dict[str, Any]:
    """The picks that were given, in the units of the dataset; tell where it holds only their neighbours."""
    import numpy as np
    import xarray as xr

    given = {name: value for name, value in picks.items() if value not in (None, ())}
    if not isinstance(found, xr.Dataset):
        return given
    if "frequency" in given:
        given["beta"] = 2.0 * pi * given.pop("frequency") / found.attrs["omega_n"]
    if "amplitude" in given:
        factor = 1.0 if found.attrs.get("excitation") == "force" else 1e-3
        given["amplitude"] = [value * factor for value in given["amplitude"]]
    for name in ("beta", "amplitude"):
        for value in np.atleast_1d(given.get(name, ())):
            there = np.atleast_1d(found[name].values)
            nearest = there[np.abs(there - value).argmin()]
            if not isclose(nearest, value, rel_tol=1e-6):
                unit = found[name].attrs.get("units", "1").replace("1", "")
                told = f"{name} {value:.6g} {unit}".rstrip()
                log.warning(f"{told}: the nearest one there is {nearest:.6g}")
    return given


def _require_kind(kind: str, path: Path) -> None:
    """Refuse a figure of a diagnosis for a dataset, and the reverse."""
    if path.is_dir() and kind in DESCRIPTIONS:
        valid = ", ".join(diagnosis.DESCRIPTIONS)
        message = f"{path}: a directory; {kind} draws the dataset of a run, a diagnosis has {valid}"
        raise Failure(message)
    if path.is_file() and kind in diagnosis.DESCRIPTIONS:
        message = f"{path}: not a directory; {kind} draws what 'wedgesweep diagnose -o DIR' left in DIR"
        raise Failure(message)


def _require_place(file: Path) -> None:
    """Check before the drawing that the file can be written."""
    if file.suffix.lower() not in FORMATS:
        message = f"{file}: the suffix must be one of {', '.join(FORMATS)}"
        raise Failure(message)
    if not file.parent.is_dir() or not os.access(file.parent, os.W_OK):
        message = f"{file.parent}: not a directory that can be written to"
        raise Failure(message)


def _draw_all(
    found: "xr.Dataset | DiagnosisResult", directory: Path, suffix: str, options: dict[str, Any]
) -> None:
    drawn = 0
    for kind in figures.of(found):
        try:
            _draw(kind, found, directory / f"{kind}.{suffix}", options, strict=False)
            drawn += 1
        except ValueError as error:
            log.info(f"skipped {error}")
    if not drawn:
        message = "no figure suits this dataset"
        raise Failure(message)


def _draw(
    kind: str, found: "xr.Dataset | DiagnosisResult", file: Path, options: dict[str, Any], strict: bool = True
) -> None:
    import xarray as xr

    picks = _accepted(kind, figures.options(figures.of(found)[kind]), options, strict)
    try:
        figures.save(figures.draw(found, kind, **picks), file)
    except DAMAGE as error:
        if isinstance(found, xr.Dataset):  # whose content has been checked
            raise
        message = f"{kind}: diagnosis.json or diagnosis.nc is not as a diagnosis writes it"
        told = f"{message} ({type(error).__name__}: {error})"
        raise ValueError(told) from error
    click.echo(f"wrote {file}")


def _accepted(kind: str, names: tuple[str, ...], options: dict[str, Any], strict: bool) -> dict[str, Any]:
    """Select the options that the figure takes, by its names; another one is an error if strict."""
    accepted = {}
    for name, value in options.items():
        if name == "amplitude" and "amplitudes" in names:
            accepted["amplitudes"] = value
        elif name == "amplitude" and name in names:
            if len(value) > 1:
                message = f"{kind}: takes a single --amplitude"
                raise ValueError(message)
            accepted[name] = value[0]
        elif name in names:
            accepted[name] = value
        elif strict:
            message = f"{kind}: takes no --{name}"
            raise ValueError(message)
    return accepted
