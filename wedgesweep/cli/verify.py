"""run --verify: print how far random cases are from what Radau finds."""

from typing import TYPE_CHECKING

import click

from wedgesweep.cli.failure import SOME_FAILED
from wedgesweep.cli.messages import log
from wedgesweep.cli.summary import LISTED
from wedgesweep.formatting import counted

if TYPE_CHECKING:
    import xarray as xr

    from wedgesweep.sweep.run import Sweep
    from wedgesweep.sweep.verification import VerifiedCase


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
