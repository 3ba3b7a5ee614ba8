"""run: all cases of a config into a dataset."""

from functools import partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from wedgesweep.cli.failure import INTERRUPTED, SOME_FAILED, Failure
from wedgesweep.cli.options import CONFIG, N_JOBS, OutputPath, command_line, jobs
from wedgesweep.cli.progress import Progress
from wedgesweep.cli.summary import print_summary
from wedgesweep.cli.words import duration
from wedgesweep.solvers.names import SOLVERS

if TYPE_CHECKING:
    from wedgesweep.config import Config
    from wedgesweep.sweep.backend import Backend
    from wedgesweep.sweep.run import Sweep

BACKENDS = ("threads", "loky", "dask")


@click.command()
@CONFIG
@click.option("-o", "--output", type=OutputPath(), help="Dataset; default: CONFIG's name, here.")
@N_JOBS
@click.option("--solver", type=click.Choice(SOLVERS), help="Instead of the config's solver.method.")
@click.option("--keep-going/--fail-fast", default=True, help="After a failed case; default: keep going.")
@click.option(
    "--case-timeout",
    type=click.FloatRange(min=0.0, min_open=True),
    metavar="SECONDS",
    help="Time limit of a case (radau only), instead of the config's.",
)
@click.option(
    "--backend",
    type=click.Choice(BACKENDS),
    help="Threads here (default of event-driven), processes here (loky, default of radau), or a Dask "
    "cluster: of --n-jobs processes here, or the --scheduler's.",
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Running Dask scheduler (tcp://host:8786), its workers with one thread each.",
)
@click.option("--fresh", is_flag=True, help="Discard what earlier runs of this output finished.")
@click.pass_context
def run(
    ctx: click.Context,
    config_path: Path,
    output: Path | None,
    n_jobs: int | None,
    solver: str | None,
    keep_going: bool,
    case_timeout: float | None,
    backend: str | None,
    scheduler: str | None,
    fresh: bool,
) -> None:
    """Run all cases of CONFIG and store them as netCDF.

    After an interruption or a kill the same command goes on where it stopped.
    """
    _require_sense(backend, scheduler, n_jobs)
    settings = _settings(config_path, solver)
    from wedgesweep.errors import MismatchError
    from wedgesweep.sweep.run import CaseFailedError, Sweep

    sweep = Sweep(settings, output or Path(f"{config_path.stem}.nc"))
    progress = Progress()
    try:
        options = {
            "n_jobs": jobs(n_jobs),
            "case_timeout": case_timeout,
            "fail_fast": not keep_going,
            "backend": _backend(backend, scheduler),
            "fresh": fresh,
        }
        ctx.exit(_run(sweep, progress, options))
    except KeyboardInterrupt:
        _stopped(progress, sweep, "interrupted", "the same command goes on from there")
        ctx.exit(INTERRUPTED)
    except CaseFailedError as error:
        _stopped(progress, sweep, f"stopped at {error}", "without --fail-fast the rest is run")
        ctx.exit(SOME_FAILED)
    except MismatchError as error:
        message = f"{error}; another -o keeps it, --fresh discards it"
        raise Failure(message) from error


def _settings(config_path: Path, solver: str | None) -> "Config":
    from wedgesweep import config

    settings = config.load(config_path)
    try:
        return settings.with_method(solver) if solver else settings
    except config.ConfigError as error:
        raise config.ConfigError([f"{config_path}: {problem}" for problem in error.problems]) from error


def _require_sense(backend: str | None, scheduler: str | None, n_jobs: int | None) -> None:
    if scheduler is None:
        return
    if backend != "dask":
        message = "--scheduler needs --backend dask"
        raise click.UsageError(message)
    if n_jobs is not None:
        message = "--n-jobs has no effect with --scheduler, whose cluster has its own workers"
        raise click.UsageError(message)


def _backend(name: str | None, scheduler: str | None) -> "Backend | None":
    """The backend of a name; None leaves the choice to the sweep."""
    if name == "dask":
        from wedgesweep.sweep import cluster

        return partial(cluster.dask, scheduler=scheduler)
    from wedgesweep.sweep import backend

    return {None: None, "threads": backend.threads, "loky": backend.loky}[name]


def _run(sweep: "Sweep", progress: Progress, options: dict[str, Any]) -> int:
    """Run the sweep unless it is complete; the exit code."""
    stored = None if options["fresh"] else sweep.stored()
    if stored is not None:
        click.echo(f"{sweep.out}: complete already; --fresh runs it again")
        return print_summary(stored)
    tell_of_compiling(sweep.settings.method, sweep.extended)
    if sweep.config.remark:
        click.echo(sweep.config.remark, err=True)
    started = perf_counter()
    result = sweep.run(progress=progress, command=command_line(), **options)
    code = print_summary(result)
    click.echo(f"wall time: {duration(perf_counter() - started)}\ndataset: {sweep.out}")
    return code


def tell_of_compiling(method: str, extended: bool = False) -> None:
    """Say why nothing seems to happen at first."""
    from wedgesweep.sweep.cases import is_compiled

    if not is_compiled(method, extended):
        click.echo("compiling once, for up to a minute; later runs start at once", err=True)


def _stopped(progress: Progress, sweep: "Sweep", reason: str, advice: str) -> None:
    progress.stop()
    kept = f"{progress.done} cases are kept in {sweep.journal_path}"
    click.echo(f"{reason}\n{kept}; {advice}", err=True)
