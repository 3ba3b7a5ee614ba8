"""run: solve all cases of a config and store them as one dataset."""

from functools import partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from wedgesweep.cli.compiling import announce_compiling
from wedgesweep.cli.failure import SOME_FAILED, Failure, exit_code
from wedgesweep.cli.messages import log
from wedgesweep.cli.options import CONFIG, N_JOBS, PLUGIN, FiniteRange, OutputPath, WholeRange, command_line
from wedgesweep.cli.progress import ProgressReport
from wedgesweep.cli.summary import MANY, print_summary, print_verification, require_confirmed
from wedgesweep.files import NETCDF
from wedgesweep.formatting import counted, duration
from wedgesweep.solvers.names import SOLVERS

if TYPE_CHECKING:
    import xarray as xr

    from wedgesweep.config import Config
    from wedgesweep.sweep.backend import Backend
    from wedgesweep.sweep.run import Sweep

BACKENDS = ("threads", "loky", "dask")


@click.command()
@CONFIG
@PLUGIN
@click.option(
    "-o",
    "--output",
    type=OutputPath(NETCDF),
    help="Dataset to write; default: CONFIG's name with .nc, in the current directory.",
)
@N_JOBS
@click.option(
    "--solver", type=click.Choice(SOLVERS), help="Solver to use instead of the config's solver.method."
)
@click.option(
    "--fail-fast/--keep-going",
    default=False,
    help="Whether to stop at the first case that fails; default: keep going.",
)
@click.option(
    "--case-timeout",
    type=FiniteRange(min=0.0, min_open=True),
    metavar="SECONDS",
    help="Time limit per case (radau only); overrides the config's solver.case_timeout_s.",
)
@click.option(
    "--backend",
    type=click.Choice(BACKENDS),
    help="Where cases run: threads (default for event-driven), processes (loky, default for radau), or a "
    "Dask cluster, either a local one of --n-jobs processes or that of --scheduler.",
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Address of a running Dask scheduler (tcp://host:8786) whose workers have one thread each.",
)
@click.option("--fresh", is_flag=True, help="Discard the results of earlier runs of this output.")
@click.option("--yes", is_flag=True, help=f"Run even if there are more than {MANY} cases.")
@click.option(
    "--verify",
    type=WholeRange(min=1),
    metavar="N",
    help="Solve N random cases of the result, also of an earlier run, again by Radau at rtol 1e-9, and print "
    "the largest difference; exit code 1 beyond 1e-3 of an amplitude ratio or a stick fraction of 1e-2.",
)
@click.option("--seed", type=WholeRange(min=0), default=0, show_default=True, help="Seed of --verify.")
@click.pass_context
def run(
    ctx: click.Context,
    config_path: Path,
    output: Path | None,
    solver: str | None,
    backend: str | None,
    scheduler: str | None,
    **options: Any,
) -> None:
    """Run all cases of CONFIG and store them as netCDF.

    Finished cases are stored at once: after an interruption, rerun the same command to resume.
    """
    _require_consistent(backend, scheduler, options["n_jobs"])
    settings, count, seed = _settings(config_path, solver), options.pop("verify"), options.pop("seed")
    if count is not None:
        _require_sine(settings, config_path)
    from wedgesweep.errors import MismatchError
    from wedgesweep.sweep.backend import count_jobs
    from wedgesweep.sweep.run import CaseFailedError, Sweep

    sweep = Sweep(settings, output or Path(f"{config_path.stem}.nc"), command_line())
    progress, jobs = ProgressReport(), count_jobs(options["n_jobs"])
    try:
        options |= {"n_jobs": jobs, "backend": _backend(backend, scheduler)}
        result, code = _run(sweep, progress, options)
    except KeyboardInterrupt as interrupt:
        _stopped(progress, sweep, "interrupted", "rerun the same command to resume")
        ctx.exit(exit_code(interrupt))
    except CaseFailedError as error:
        _stopped(
            progress, sweep, f"stopped at {error}", "rerun without --fail-fast to solve the remaining cases"
        )
        ctx.exit(SOME_FAILED)
    except MismatchError as error:
        raise Failure(f"{error}; choose another -o to keep it, or --fresh to discard it") from error
    if count is not None:
        code = max(code, print_verification(sweep, result, count, seed, jobs))
    ctx.exit(code)


def _settings(config_path: Path, solver: str | None) -> "Config":
    from wedgesweep import config
    from wedgesweep.config.variants import with_method

    settings = config.load(config_path)
    try:
        return with_method(settings, solver) if solver else settings
    except config.ConfigError as error:
        raise config.ConfigError([f"{config_path}: {problem}" for problem in error.problems]) from error


def _require_sine(settings: "Config", config_path: Path) -> None:
    """Refuse to verify responses to an input that does not repeat."""
    if settings.transient:
        raise Failure(
            f"{config_path}: --verify compares responses to a sine, and this input does not repeat; "
            "run it again with --solver radau and another -o"
        )


def _require_consistent(backend: str | None, scheduler: str | None, n_jobs: int | None) -> None:
    if scheduler is None:
        return
    if backend != "dask":
        raise click.UsageError("--scheduler needs --backend dask")
    if n_jobs is not None:
        raise click.UsageError("--n-jobs has no effect with --scheduler, whose cluster has its own workers")


def _backend(name: str | None, scheduler: str | None) -> "Backend | None":
    """Return the backend of a name; None leaves the choice to the sweep."""
    if name == "dask":
        from wedgesweep.sweep import cluster

        return partial(cluster.dask, scheduler=scheduler)
    from wedgesweep.sweep import backend

    return {None: None, "threads": backend.threads, "loky": backend.loky}[name]


def _run(sweep: "Sweep", progress: ProgressReport, options: dict[str, Any]) -> tuple["xr.Dataset", int]:
    """Run the sweep unless it is complete; return its dataset and the exit code."""
    confirmed = options.pop("yes")
    announce_compiling()
    stored = None if options["fresh"] else sweep.stored()
    if stored is not None:
        click.echo(f"{sweep.out}: already complete; use --fresh to run it again")
        return stored, print_summary(stored)
    print_remark(sweep.config)
    require_confirmed(sweep, options["n_jobs"], confirmed)
    started = perf_counter()
    try:
        result = sweep.run(progress=progress.cases, tell=log.warning, **options)
    finally:
        progress.stop()
    code = print_summary(result)
    click.echo(f"wall time: {duration(perf_counter() - started)}\ndataset: {sweep.out}")
    return result, code


def print_remark(settings: "Config") -> None:
    """Print what is to be known of the friction of a config."""
    if settings.remark:
        log.info(f"note: {settings.remark}")


def _stopped(progress: ProgressReport, sweep: "Sweep", reason: str, advice: str) -> None:
    finished = counted(progress.done, "finished case")
    kept = f"{finished} {'is' if progress.done == 1 else 'are'} stored in {sweep.journal_path}"
    click.echo(f"{reason}\n{kept}; {advice}", err=True)
