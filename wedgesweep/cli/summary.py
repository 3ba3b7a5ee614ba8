"""Summary of how the cases ended, for run and status."""

from typing import TYPE_CHECKING

import click

from wedgesweep import formatting
from wedgesweep.cli.failure import SOME_FAILED

if TYPE_CHECKING:
    import xarray as xr

    from wedgesweep.sweep.outcomes import Outcomes

LISTED = 5


def print_summary(ds: "xr.Dataset") -> int:
    """Print counts and the first failures; return the exit code."""
    from wedgesweep.sweep import outcomes

    return print_outcomes(outcomes.of_dataset(ds))


def print_outcomes(found: "Outcomes", total: int | None = None) -> int:
    """Print the summary of the finished cases out of ``total``; return the exit code."""
    counts = ", ".join(f"{count} {status}" for status, count in found.counts.items())
    remaining = "" if total is None else f", {total - len(found)} remaining"
    click.echo(f"{formatting.counted(total or len(found), 'case')}: {counts or 'none finished'}{remaining}")
    _print_share(found.unsettled, len(found), "did not reach steady state (variables period, periodicity)")
    _print_share(
        found.lifted,
        len(found),
        f"{'lies' if found.lifted == 1 else 'lie'} outside of the model's validity: a joint pulls where "
        "a real one would lift off (variable lift_off_fraction)",
    )
    failed = found.failures
    for place in failed[:LISTED].tolist():
        click.echo(f"  {found[place]}")
    if len(failed) > LISTED:
        click.echo(f"  and {len(failed) - LISTED} more")
    return SOME_FAILED if len(failed) else 0


def _print_share(count: int, total: int, what: str) -> None:
    if count:
        share = f"{count} of {formatting.counted(total, 'case')} ({100.0 * count / total:.3g} %)"
        click.echo(f"  {share} {what}")
