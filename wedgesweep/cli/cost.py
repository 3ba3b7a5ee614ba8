"""What a sweep will cost: printed by check, and by run where it is a lot."""

from typing import TYPE_CHECKING

import click

from wedgesweep import formatting
from wedgesweep.cli.failure import Failure
from wedgesweep.formatting import duration, size

if TYPE_CHECKING:
    from wedgesweep.sweep.run import Sweep

# More cases than this run only if that was confirmed.
MANY = 10_000_000


def print_cost(sweep: "Sweep", n_jobs: int) -> None:
    """Time some cases of a sweep; print what all cases need, and how many of those run here failed."""
    from wedgesweep.sweep.estimate import estimate

    cost, jobs = estimate(sweep, n_jobs), formatting.counted(n_jobs, "job")
    cases = formatting.counted(cost.sampled.size, "case")
    click.echo(
        f"time: about {duration(cost.seconds)} on {jobs} (from {cases} run now)\n"
        f"memory: about {size(cost.memory)} on {jobs}, {size(cost.bytes_per_case)} of it for each case\n"
        f"dataset: at most {size(cost.dataset_bytes)}, less after compression"
    )
    failed = cost.sampled[cost.sampled["status"] != 0]
    if failed.size:
        reason = failed[0]["message"].decode()
        click.echo(f"of those, {formatting.counted(failed.size, 'case')} failed, the first by: {reason}")


def require_confirmed(sweep: "Sweep", n_jobs: int, confirmed: bool) -> None:
    """Refuse a sweep of very many cases, with what it would cost, unless that was confirmed."""
    if sweep.count > MANY and not confirmed:
        print_cost(sweep, n_jobs)
        message = f"{sweep.count} cases are more than {MANY}: --yes runs them all the same"
        raise Failure(message)
