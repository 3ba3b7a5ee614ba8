"""What run, check and status print of a sweep: cost, how cases ended, how far off Radau finds them."""

from typing import TYPE_CHECKING

import click

from wedgesweep.cli.failure import SOME_FAILED, Failure
from wedgesweep.cli.messages import log
from wedgesweep.formatting import counted, duration, size
from wedgesweep.outcome import Outcome, lifted, unsettled

if TYPE_CHECKING:
    import xarray as xr

    from wedgesweep.sweep.run import Sweep
    from wedgesweep.sweep.verification import VerifiedCase

# More cases than this run only if that was confirmed.
MANY = 10_000_000
LISTED = 5


def print_cost(sweep: "Sweep", n_jobs: int) -> None:
    """Time some cases of a sweep; print what all cases need, and how many of those run here failed."""
    from wedgesweep.sweep.estimate import estimate

    cost, jobs = estimate(sweep, n_jobs), counted(n_jobs, "job")
    cases = counted(cost.sampled.size, "case")
    click.echo(
        f"time: about {duration(cost.seconds)} on {jobs} (from {cases} run now)\n"
        f"memory: about {size(cost.memory)} on {jobs}, {size(cost.bytes_per_case)} of it for each case\n"
        f"dataset: at most {size(cost.dataset_bytes)}, less after compression"
    )
    failed = cost.sampled[cost.sampled["status"] != 0]
    if failed.size:
        reason = failed[0]["message"].decode()
        click.echo(f"of those, {counted(failed.size, 'case')} failed, the first by: {reason}")


def require_confirmed(sweep: "Sweep", n_jobs: int, confirmed: bool) -> None:
    """Refuse a sweep of very many cases, with what it would cost, unless that was confirmed."""
    if sweep.count > MANY and not confirmed:
        print_cost(sweep, n_jobs)
        raise Failure(f"{sweep.count} cases are more than {MANY}: --yes runs them all the same")


def print_summary(ds: "xr.Dataset") -> int:
    """Print how the cases of a dataset ended, and the first failures; return the exit code."""
    from wedgesweep.sweep import outcomes

    total, counts = ds["status"].size, outcomes.counts(ds)
    remaining = counts.pop(Outcome.NOT_RUN, None)
    ended = ", ".join(f"{count} {outcome}" for outcome, count in counts.items()) or "none finished"
    click.echo(f"{counted(total, 'case')}: {ended}{f', {remaining} remaining' if remaining else ''}")
    finished, pulling = sum(counts.values()), int(lifted(ds).sum())
    _print_share(
        int(unsettled(ds).sum()), finished, "did not reach steady state (variables period, periodicity)"
    )
    _print_share(
        pulling,
        finished,
        f"{'lies' if pulling == 1 else 'lie'} outside of the model's validity: a joint pulls where "
        "a real one would lift off (variable lift_off_fraction)",
    )
    failed = outcomes.failures(ds).tolist()
    for place in failed[:LISTED]:
        click.echo(f"  {outcomes.described(ds, place)}")
    if len(failed) > LISTED:
        click.echo(f"  and {len(failed) - LISTED} more")
    return SOME_FAILED if failed else 0


def _print_share(count: int, total: int, what: str) -> None:
    if count:
        share = f"{count} of {counted(total, 'case')} ({100.0 * count / total:.3g} %)"
        click.echo(f"  {share} {what}")


def print_verification(sweep: "Sweep", ds: "xr.Dataset", count: int, seed: int, n_jobs: int) -> int:
    """Solve random cases again and print the largest differences; return the exit code."""
    from wedgesweep.sweep import verification

    log.info(f"verifying at most {counted(count, 'random case')} by Radau")
    found = verification.verify(sweep, ds, count, seed, n_jobs)
    verifiable = found.verifiable
    cases = counted(len(verifiable), "case")
    click.echo(
        f"verified by Radau at rtol {verification.RTOL:g}: {cases} out of {found.candidates} "
        f"that were solved (random, seed {found.seed})"
    )
    for name, words in (("ratio", "amplitude ratio"), ("stick", "stick fraction")):
        if verifiable:
            worst = verification.largest(verifiable, name)
            apart = getattr(worst.apart, name)
            click.echo(f"  largest difference of the {words}: {apart:.2g}, at {_numbers_of(worst, name)}")
    for case in [case for case in found.cases if case.message][:LISTED]:
        click.echo(f"  not verified: {case.case}: {case.message}")
    wrong = [case for case in verifiable if case.is_wrong]
    if wrong:
        ratio, small, stick = verification.RATIO_BOUND, verification.SMALL_RATIO, verification.STICK_BOUND
        click.echo(
            f"  {len(wrong)} of {len(verifiable)} cases differ by more than {ratio:g} of the amplitude ratio "
            f"(of {small:g} where it is smaller) or a stick fraction of {stick:g}:"
        )
    for case in wrong[:LISTED]:
        click.echo(f"    {_numbers_of(case, 'ratio')}; stick fraction {_pair(case, 'stick')}")
    return SOME_FAILED if wrong or not verifiable else 0


def _numbers_of(case: "VerifiedCase", name: str) -> str:
    return f"{case.case}: {_pair(case, name)}"


def _pair(case: "VerifiedCase", name: str) -> str:
    return f"{getattr(case.stored, name):.6g}, by Radau {getattr(case.reference, name):.6g}"
