"""init, schema, check: write and check configs."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from wedgesweep import formatting
from wedgesweep.cli.compiling import announce_compiling
from wedgesweep.cli.failure import Failure
from wedgesweep.cli.measurement import print_measurement
from wedgesweep.cli.options import CONFIG, PLUGIN, STANDARD_OUTPUT, GivenPath, OutputPath, require_kind
from wedgesweep.cli.run import print_remark
from wedgesweep.cli.summary import print_cost
from wedgesweep.files import ENDINGS, JSON, TOML, write_text
from wedgesweep.kinds import CONFIG_OR_MEASURED, DIAGNOSIS, SWEEP, is_measured, kind_of

if TYPE_CHECKING:
    from wedgesweep.config import Config


@click.command()
@click.argument("paths", metavar="[PATH]", nargs=-1, type=GivenPath())
@click.option("--data", "files", metavar="FILE...", multiple=True, type=GivenPath(), help="Measured data.")
@click.option("--force", is_flag=True, help="Overwrite existing files.")
def init(paths: tuple[Path, ...], files: tuple[Path, ...], force: bool) -> None:
    """Write a first file: a config with every key, or with --data a measured.toml.

    PATH is wedgesweep.toml by default, with --data measured.toml; - prints the config. With --data the
    files are looked at, a model.toml is written as well, and both are checked: what columns, units, kinds of
    test and numbers of the model seem to be, with questions where that is not clear. If FILE is a
    measured.toml, the numbers of a model are estimated once more, and PATH is that of the model.
    """
    if files:
        from wedgesweep.guess import first_files

        written = [path for path in paths if path.suffix in ENDINGS[TOML][:1]]
        data = [*files, *(path for path in paths if path not in written)]
        default = first_files.MODEL if all(map(is_measured, data)) else "measured.toml"
        _init_from(written or [Path(default)], data, force)
        return
    from wedgesweep import config

    path = _output([*paths] or [Path("wedgesweep.toml")], force)
    _put(config.template(), path)


def _output(paths: list[Path], force: bool) -> Path:
    """The one path to write to."""
    if len(paths) > 1:
        raise click.UsageError(f"Got unexpected extra argument ({paths[1]})")
    path = OutputPath(TOML, allow_dash=True).convert(paths[0], None, click.get_current_context())
    if path.exists() and not force:
        raise Failure(f"{path}: exists; --force overwrites it")
    return path


def _init_from(paths: list[Path], files: list[Path], force: bool) -> None:
    """Write a measured.toml and a model for data files, and check them."""
    from wedgesweep import measured
    from wedgesweep.guess import first_files

    path = _output(paths, force)
    if all(map(is_measured, files)):
        first_files.write_model(path, files[0])
        click.echo(f"wrote {path}")
        return
    _output([path.parent / first_files.MODEL], force)
    for written in first_files.write(path, files):
        click.echo(f"wrote {written}")
    print_measurement(measured.read(path))


@click.command()
@click.option(
    "-o",
    "--output",
    default="-",
    type=OutputPath(JSON, allow_dash=True),
    help="File to write; default: print.",
)
def schema(output: Path) -> None:
    """Write the JSON schema of configs, for editors.

    With the schema an editor checks and completes what is typed.
    """
    from wedgesweep import config

    _put(json.dumps(config.schema(), indent=2) + "\n", output)


@click.command()
@CONFIG
@PLUGIN
def check(config_path: Path) -> None:
    """Check a config, or measured data (measured.toml).

    For a config, a few timed cases give an estimate of the time and memory that a run needs. For measured
    data, the tests are listed with their frequencies and noise.
    """
    from wedgesweep import config

    if kind_of(config_path) in (SWEEP, DIAGNOSIS):
        require_kind(config_path, CONFIG_OR_MEASURED)
    if is_measured(config_path):
        from wedgesweep import measured

        print_measurement(measured.read(config_path))
        return
    settings = config.load(config_path)
    click.echo(f"{config_path}: valid\ntitle: {settings.title}\ncases: {_grid(settings)}")
    print_remark(settings)
    from wedgesweep.sweep.backend import count_jobs
    from wedgesweep.sweep.run import Sweep

    sweep = Sweep(settings, Path(f"{config_path.stem}.nc"))
    announce_compiling()
    print_cost(sweep, count_jobs(None))


def _grid(settings: "Config") -> str:
    """Describe the number of cases as the product of the sweep's axes."""
    sweep = settings.sweep
    if sweep.dims == ("case",):
        return f"{sweep.count}, listed individually"
    names = {"friction_law": "friction law", "beta": "frequency", "sample": "sample"}
    parts = []
    for dim, size in zip(sweep.dims, sweep.shape, strict=True):
        name = names.get(dim, dim)
        if dim in (*names, "frequency", "amplitude", "scale"):
            parts.append(formatting.counted(size, name, "frequencies" if name == "frequency" else ""))
        else:
            parts.append(f"{size} of {name}")
    return f"{sweep.count} = {' x '.join(parts)}"


def _put(text: str, path: Path) -> None:
    if path == STANDARD_OUTPUT:
        click.echo(text, nl=False)
        return
    write_text(path, text)
    click.echo(f"wrote {path}")
