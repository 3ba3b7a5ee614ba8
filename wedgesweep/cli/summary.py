"""What became of the cases, for run and status."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from wedgesweep.cli.failure import SOME_FAILED

if TYPE_CHECKING:
    import xarray as xr

    from wedgesweep.sweep.outcomes import CaseResult

LISTED = 5


def print_summary(ds: "xr.Dataset") -> int:
    """Print counts and the first failures; the exit code that they mean."""
    from wedgesweep.sweep import outcomes

    return print_outcomes(outcomes.of_dataset(ds))


def print_outcomes(found: Sequence["CaseResult"], total: int | None = None) -> int:
    """As print_summary, of the finished cases of ``total``."""
    from wedgesweep.sweep import outcomes

    counts = ", ".join(f"{count} {status}" for status, count in outcomes.counts(found).most_common())
    remaining = "" if total is None else f", {total - len(found)} remaining"
    click.echo(f"{total or len(found)} cases: {counts or 'none finished'}{remaining}")
    if changing := len(outcomes.unsettled(found)):
        click.echo(
            f"  {changing} of the ok ones had not settled when they ended (variables period, periodicity)"
        )
    failed = outcomes.failures(found)
    for outcome in failed[:LISTED]:
        click.echo(f"  {outcome}")
    if len(failed) > LISTED:
        click.echo(f"  and {len(failed) - LISTED} more")
    return SOME_FAILED if failed else 0
