"""reproduce: check the paper's claims, and test hypotheses on Chandiramani's experiment."""

from pathlib import Path

import click

from wedgesweep.cli.compiling import announce_compiling
from wedgesweep.cli.options import N_JOBS, GivenPath
from wedgesweep.cli.progress import ProgressReport


@click.command()
@click.option(
    "-o",
    "--output",
    type=GivenPath(file_okay=False),
    default="reproduction",
    show_default=True,
    help="Directory for the datasets and the report.",
)
@click.option(
    "--only",
    type=click.Choice(["claims", "chandiramani"]),
    help="Check only the paper's claims, or test only the hypotheses on Chandiramani's experiment (minutes).",
)
@N_JOBS
@click.pass_context
def reproduce(ctx: click.Context, output: Path, only: str | None, n_jobs: int | None) -> None:
    """Run the paper's cases, and check its claims.

    Also tests which hypotheses explain Chandiramani's experiment, with which the paper compares its results.
    Takes 40 minutes on two cores; finished cases are stored: rerun the same command to resume. Exits with
    code 1 if a verdict differs from the recorded one.
    """
    from wedgesweep.reproduce import reproduce as run_all
    from wedgesweep.sweep.backend import count_jobs

    output.mkdir(parents=True, exist_ok=True)
    announce_compiling()
    as_recorded = run_all(output, count_jobs(n_jobs), click.echo, ProgressReport().cases, only=only)
    ctx.exit(0 if as_recorded else 1)
