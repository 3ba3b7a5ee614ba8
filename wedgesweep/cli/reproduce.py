"""reproduce: check the paper's claims, and search what may explain Chandiramani's experiment."""

from pathlib import Path

import click

from wedgesweep.cli.compiling import announce_compiling
from wedgesweep.cli.options import N_JOBS
from wedgesweep.cli.progress import ProgressReport


@click.command()
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default="reproduction",
    show_default=True,
    help="Directory for the datasets and the report.",
)
@click.option(
    "--only",
    type=click.Choice(["claims", "chandiramani"]),
    help="Check only the paper's claims, or search only Chandiramani's experiment (minutes).",
)
@N_JOBS
@click.pass_context
def reproduce(ctx: click.Context, output: Path, only: str | None, n_jobs: int | None) -> None:
    """Run the paper's cases, and check its claims.

    Also searches what may explain the experiment that the paper compares itself with. Exits with code 1 if a
    verdict differs from the recorded one. Finished cases are stored: rerun the same command to resume.
    """
    from wedgesweep.reproduce import reproduce as run_all
    from wedgesweep.sweep.backend import count_jobs

    output.mkdir(parents=True, exist_ok=True)
    announce_compiling()
    as_recorded = run_all(output, count_jobs(n_jobs), click.echo, ProgressReport(), only=only)
    ctx.exit(0 if as_recorded else 1)
