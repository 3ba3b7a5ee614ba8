"""Arguments and options shared by several commands."""

import os
import shlex
import sys
from collections.abc import Iterable
from math import inf, isfinite
from pathlib import Path
from typing import Any, ClassVar

import click

from wedgesweep.cli.failure import Failure
from wedgesweep.files import mismatch, replaceable
from wedgesweep.kinds import confusion
from wedgesweep.units import SI, SYSTEMS


class GivenPath(click.Path):
    """A path that a system can take; an empty one, of an unset variable, would be the current directory."""

    def __init__(self, **options: bool) -> None:
        super().__init__(path_type=Path, **options)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        path = os.fsdecode(value)
        if not path:
            self.fail("an empty path; give that of a file or directory.", param, ctx)
        if "\0" in path:
            self.fail("a path cannot hold a null character.", param, ctx)
        return super().convert(value, param, ctx)


CONFIG = click.argument("config_path", metavar="CONFIG", type=GivenPath())
DATASET = click.argument("path", metavar="OUT", type=GivenPath())

# A path that stands for the standard output.
STANDARD_OUTPUT = Path("-")


class WholeRange(click.IntRange):
    """A whole number in a range."""

    name = "whole number"


N_JOBS = click.option(
    "--n-jobs",
    type=WholeRange(min=1),
    metavar="N",
    default=None,
    help="Number of parallel jobs; default: one per processor.",
)


def _load_plugins(ctx: click.Context, param: click.Parameter, given: tuple[Path, ...]) -> None:
    if given:
        from wedgesweep import plugins

        plugins.load_all(given)


PLUGIN = click.option(
    "--plugin",
    type=GivenPath(exists=True, dir_okay=False),
    multiple=True,
    is_eager=True,
    expose_value=False,
    callback=_load_plugins,
    metavar="FILE",
    help="Python file with an effect of your own (docs/extending.md); may be repeated.",
)


UNITS = click.option(
    "--units",
    type=click.Choice(list(SYSTEMS)),
    default=SI,
    show_default=True,
    help="Units of the numbers: SI; us: in, lb, lbf; us-kip: with forces in kip.",
)


AT = click.option(
    "--at",
    metavar="AXIS=VALUE",
    multiple=True,
    help="Value of a number of the model, such as suspension.wedge_angle_deg=30; may be repeated. Of a "
    "dataset the nearest one is drawn, of any axis (amplitudes in mm or N); default: the middle, or where "
    "most cases slip.",
)


def axis_values(texts: Iterable[str]) -> dict[str, float | str]:
    """Values out of texts such as "suspension.wedge_angle_deg=30"; words stay words."""
    values: dict[str, float | str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not (name and equals):
            raise click.UsageError(f"--at {text}: not AXIS=VALUE")
        try:
            values[name] = float(value)
        except ValueError:
            values[name] = value
    return values


class FiniteRange(click.FloatRange):
    """A number in a range; a comparison alone does not refuse nan."""

    name = "number"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        found = super().convert(value, param, ctx)
        if not isfinite(found):
            self.fail(f"{value} is not a finite number.", param, ctx)
        return found


class Duration(click.ParamType):
    """A time with its unit, converted to seconds: 60s, 10min, 1h."""

    name = "duration"
    UNITS: ClassVar = {"s": 1.0, "min": 60.0, "h": 3600.0}

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        if isinstance(value, float):
            return value
        number = value.rstrip("abcdefghijklmnopqrstuvwxyz ")
        try:
            seconds = float(number) * self.UNITS[value[len(number) :].strip()]
        except (ValueError, KeyError):
            seconds = 0.0
        if not 0.0 < seconds < inf:
            self.fail(f"{value!r} is not a time such as 60s, 10min or 1h.", param, ctx)
        return seconds


class OutputPath(GivenPath):
    """A file to write in some format (see ``files.ENDINGS``), checked before any work is done."""

    def __init__(self, written: str | None = None, **options: bool) -> None:
        super().__init__(dir_okay=False, writable=True, **options)
        self.written = written

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        try:
            replaceable(Path(os.fsdecode(value)))
        except OSError as error:
            self.fail(f"{error.filename}: {error.strerror}.", param, ctx)
        path = Path(os.fsdecode(super().convert(value, param, ctx)))
        if self.allow_dash and path == STANDARD_OUTPUT:
            return path
        if self.written and (problem := mismatch(path, self.written)):
            self.fail(problem, param, ctx)
        if not path.parent.is_dir():
            self.fail(f"'{path.parent}' is not a directory.", param, ctx)
        if not os.access(path.parent, os.W_OK):
            self.fail(f"Directory '{path.parent}' is not writable.", param, ctx)
        return path


def require_kind(path: Path, wanted: str) -> None:
    """Refuse a file of this package that is of another kind."""
    if problem := confusion(path, wanted):
        raise Failure(problem)


def require_place_for(directory: Path) -> None:
    """Fail before any work is done if a directory cannot be created or written to."""
    place = directory.absolute()
    while not place.exists():
        place = place.parent
    if not place.is_dir():
        raise Failure(f"{place}: not a directory")
    if not os.access(place, os.W_OK):
        raise Failure(f"{place}: cannot be written to")


def command_line() -> str:
    """Return the command line as typed, for the history of a dataset."""
    return shlex.join(["wedgesweep", *sys.argv[1:]])
