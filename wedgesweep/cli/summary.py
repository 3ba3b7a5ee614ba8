"""Summary of how the cases ended, for run and status."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from wedgesweep.cli.failure import SOME_FAILED

if TYPE_CHECKING:
    import xarray as xr

    from wedgesweep.sweep.outcomes import CaseResult

LISTED = 5


def print_summary(ds: "xr.Dataset") -> int:
    """Print counts and the first failures; return the exit code."""
    from wedgesweep.sweep import outcomes

    return print_outcomes(outcomes.of_dataset(ds))


def print_outcomes(found: Sequence["CaseResult"], total: int | None = None) -> int:
    """Print the summary of the finished cases out of ``total``; return the exit code."""
    from wedgesweep.sweep import outcomes

    counts = ", ".join(f"{count} {status}" for status, count in outcomes.counts(found).most_common())
    remaining = "" if total is None else f", {total - len(found)} remaining"
    click.echo(f"{total or len(found)} cases: {counts or 'none finished'}{remaining}")
    _print_share(
        len(outcomes.unsettled(found)),
        len(found),
        "did not reach steady state (variables period, periodicity)",
    )
    _print_share(
        len(outcomes.lifted(found)),
        len(found),
        "lift off, which the model leaves out: outside of its validity (variable lift_off_fraction)",
    )
    failed = outcomes.failures(found)
    for outcome in failed[:LISTED]:
        click.echo(f"  {outcome}")
    if len(failed) > LISTED:
        click.echo(f"  and {len(failed) - LISTED} more")
    return SOME_FAILED if failed else 0


def _print_share(count: int, total: int, what: str) -> None:
    if count:
        click.echo(f"  {count} of {total} cases {what}: {100.0 * count / total:.3g} %")
