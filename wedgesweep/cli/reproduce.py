"""reproduce: the paper's claims, one by one, and what may explain the experiment."""

from pathlib import Path

import click

from wedgesweep.cli.options import N_JOBS, jobs
from wedgesweep.cli.progress import Progress
from wedgesweep.cli.run import tell_of_compiling
from wedgesweep.solvers.names import SOLVERS


@click.command()
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default="reproduction",
    show_default=True,
    help="Directory of the datasets and the report.",
)
@click.option(
    "--only",
    type=click.Choice(["claims", "chandiramani"]),
    help="Only the paper's claims, or only the suspects of Chandiramani's experiment (minutes).",
)
@N_JOBS
@click.pass_context
def reproduce(ctx: click.Context, output: Path, only: str | None, n_jobs: int | None) -> None:
    """Run the paper's 1,800 cases and check its claims one by one; search what may explain the experiment.

    Exit code 1 if a verdict differs from the recorded one. What is finished of the runs is kept.
    """
    from wedgesweep.reproduce import reproduce as run_all

    output.mkdir(parents=True, exist_ok=True)
    tell_of_compiling(SOLVERS[0])
    as_recorded = run_all(output, n_jobs=jobs(n_jobs), report=click.echo, progress=Progress(), only=only)
    ctx.exit(0 if as_recorded else 1)
