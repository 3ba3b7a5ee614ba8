"""plot: figures of a dataset."""

import os
from collections.abc import Callable
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from wedgesweep.cli.failure import Failure
from wedgesweep.cli.options import DATASET
from wedgesweep.figures import DESCRIPTIONS, FORMATS

if TYPE_CHECKING:
    import xarray as xr

ALL = "all"
SUFFIXES = tuple(suffix[1:] for suffix in FORMATS)
KINDS = "\n".join(f"  {kind:<16} {text}" for kind, text in DESCRIPTIONS.items())
HELP = f"""Draw a figure of the dataset OUT.

\b
KIND is one of
{KINDS}
  {ALL:<16} each of them that suits the dataset
"""


@click.command(help=HELP, short_help="Draw a figure of the dataset OUT.")
@click.argument("kind", metavar="KIND", type=click.Choice([*DESCRIPTIONS, ALL]))
@DATASET
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help=f"File ({', '.join(FORMATS)}), for 'all' a directory; default: beside OUT.",
)
@click.option("--format", "suffix", type=click.Choice(SUFFIXES), default="png", show_default=True)
@click.option("--beta", type=float, help="Frequency ratio; the nearest in OUT is drawn.")
@click.option(
    "--amplitude", type=float, multiple=True, metavar="MM", help="Input amplitude; may be repeated."
)
@click.option("--law", help="Friction law.")
@click.pass_context
def plot(
    ctx: click.Context,
    kind: str,
    path: Path,
    output: Path | None,
    suffix: str,
    beta: float | None,
    amplitude: tuple[float, ...],
    law: str | None,
) -> None:
    """Draw a figure."""  # the text of --help is HELP
    wanted = {"beta": beta, "amplitude": [value * 1e-3 for value in amplitude], "law": law}
    options = {name: value for name, value in wanted.items() if value not in (None, [])}
    if kind == ALL:
        directory = output or path.parent
        directory.mkdir(parents=True, exist_ok=True)
        _draw_all(_read(path), directory, suffix, options)
        return
    file = output or path.with_name(f"{kind}.{suffix}")
    _require_place(file)
    try:
        _draw(kind, _read(path), file, options)
    except ValueError as error:
        raise Failure(str(error)) from error


def _read(path: Path) -> "xr.Dataset":
    from wedgesweep import dataset

    return dataset.read(path)


def _require_place(file: Path) -> None:
    """Complain before the drawing about what would go wrong after it."""
    if file.suffix.lower() not in FORMATS:
        message = f"{file}: the suffix must be one of {', '.join(FORMATS)}"
        raise Failure(message)
    if not file.parent.is_dir() or not os.access(file.parent, os.W_OK):
        message = f"{file.parent}: not a directory that can be written to"
        raise Failure(message)


def _draw_all(ds: "xr.Dataset", directory: Path, suffix: str, options: dict[str, Any]) -> None:
    drawn = 0
    for kind in DESCRIPTIONS:
        try:
            _draw(kind, ds, directory / f"{kind}.{suffix}", options, strict=False)
            drawn += 1
        except ValueError as error:
            click.echo(f"skipped {error}", err=True)
    if not drawn:
        message = "no figure suits this dataset"
        raise Failure(message)


def _draw(kind: str, ds: "xr.Dataset", file: Path, options: dict[str, Any], strict: bool = True) -> None:
    from wedgesweep import figures

    draw = figures.FIGURES[kind].draw
    figures.save(draw(ds, **_accepted(kind, draw, options, strict)), file)
    click.echo(f"wrote {file}")


def _accepted(kind: str, draw: Callable[..., Any], options: dict[str, Any], strict: bool) -> dict[str, Any]:
    """Options by the figure's names for them; one that it lacks is an error if strict."""
    names = signature(draw).parameters
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
