"""init, schema, check: write and check configs."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from wedgesweep.cli.failure import Failure
from wedgesweep.cli.humanize import duration, size
from wedgesweep.cli.measurement import print_measurement
from wedgesweep.cli.options import CONFIG, OutputPath
from wedgesweep.cli.run import print_remark
from wedgesweep.files import write_text

if TYPE_CHECKING:
    from wedgesweep.config import Config
    from wedgesweep.sweep.estimate import Estimate

STANDARD_OUTPUT = Path("-")


@click.command()
@click.argument("path", default="wedgesweep.toml", type=OutputPath(allow_dash=True))
@click.option("--force", is_flag=True, help="Overwrite an existing file.")
def init(path: Path, force: bool) -> None:
    """Write a commented config with every key to PATH (default: wedgesweep.toml; - prints it)."""
    from wedgesweep import config

    if path.exists() and not force:
        message = f"{path}: exists; --force overwrites it"
        raise Failure(message)
    _put(config.template(), path)


@click.command()
@click.option(
    "-o", "--output", default="-", type=OutputPath(allow_dash=True), help="File to write; default: print."
)
def schema(output: Path) -> None:
    """Write the JSON schema of configs, which lets editors check and complete them."""
    from wedgesweep import config

    _put(json.dumps(config.schema(), indent=2) + "\n", output)


@click.command()
@CONFIG
def check(config_path: Path) -> None:
    """Check a config, or measured data (measured.toml or .nc).

    For a config, a few timed cases give an estimate of the time and memory that a run needs. For measured
    data, the tests are listed with their frequencies and noise.
    """
    from wedgesweep import config, measured

    if measured.is_measured(config_path):
        print_measurement(measured.read(config_path))
        return
    settings = config.load(config_path)
    click.echo(f"{config_path}: valid\ntitle: {settings.title}\ncases: {_grid(settings)}")
    print_remark(settings)
    from wedgesweep.sweep import backend
    from wedgesweep.sweep.estimate import estimate
    from wedgesweep.sweep.run import Sweep

    sweep, n_jobs = Sweep(settings, Path(f"{config_path.stem}.nc")), backend.count_jobs(None)
    threads = backend.local(sweep.settings.method) is backend.threads
    _print_estimate(estimate(sweep), n_jobs, 1 if threads else n_jobs + 1)


def _grid(settings: "Config") -> str:
    """Describe the number of cases as the product of the grid's axes."""
    sweep, count = settings.sweep, len(settings.case_list())
    if sweep.cases is not None:
        return f"{count}, listed individually"
    if settings.transient:
        return f"{count} = {len(sweep.friction_law)} friction laws x {sweep.amplitude.size} scales"
    laws, betas, amplitudes = len(sweep.friction_law), sweep.beta.size, sweep.amplitude.size
    return f"{count} = {laws} friction laws x {betas} frequencies x {amplitudes} amplitudes"


def _print_estimate(cost: "Estimate", n_jobs: int, processes: int) -> None:
    memory = cost.process_bytes * processes + 2 * cost.dataset_bytes
    click.echo(
        f"time: about {duration(cost.seconds_on_one_job / n_jobs)} on {n_jobs} jobs "
        f"(from {cost.sampled.size} cases run now)\n"
        f"memory: about {size(memory)} on {n_jobs} jobs\n"
        f"dataset: at most {size(cost.dataset_bytes)}, less after compression"
    )
    failed = cost.sampled[cost.sampled["status"] != 0]
    if failed.size:
        reason = failed[0]["message"].decode()
        click.echo(f"{failed.size} of the {cost.sampled.size} cases failed, the first by: {reason}")


def _put(text: str, path: Path) -> None:
    if path == STANDARD_OUTPUT:
        click.echo(text, nl=False)
        return
    write_text(path, text)
    click.echo(f"wrote {path}")
