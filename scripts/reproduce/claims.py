"""All claims and their verdicts on record."""

from collections.abc import Iterator
from dataclasses import dataclass

from reproduce import experiment, integration, laws, oscillator, sticking, suspension
from reproduce.findings import CONTRADICTED, HOLDS, PARTLY, Claim, Finding
from reproduce.runs import Runs

TOPICS = (suspension, laws, sticking, oscillator, experiment, integration)
CLAIMS = tuple(
    sorted(
        (each for topic in TOPICS for each in vars(topic).values() if isinstance(each, Claim)),
        key=lambda claim: claim.number,
    )
)

# Verdict of each claim by its number. If a run finds another one, something has changed.
RECORDED = {
    1: HOLDS,
    2: CONTRADICTED,
    3: CONTRADICTED,
    4: PARTLY,
    5: PARTLY,
    6: CONTRADICTED,
    7: CONTRADICTED,
    8: PARTLY,
    9: PARTLY,
    10: PARTLY,
    11: PARTLY,
    12: PARTLY,
    13: HOLDS,
    14: CONTRADICTED,
    15: CONTRADICTED,
    16: PARTLY,
    17: PARTLY,
}
# The same with joints that lift off, of claims on large inputs.
RECORDED_UNILATERAL = {3: CONTRADICTED, 4: PARTLY, 5: PARTLY, 9: PARTLY, 10: PARTLY}


@dataclass(frozen=True)
class CheckedClaim:
    """A claim, the finding on it, and the verdict on record.

    ``unilateral``: the same with joints that lift off, None where the claim is not on large inputs.
    """

    claim: Claim
    finding: Finding
    recorded: str
    unilateral: "CheckedClaim | None" = None

    @property
    def verdict(self) -> str:
        return self.finding.verdict

    @property
    def agrees(self) -> bool:
        same = self.verdict == self.recorded
        return same and (self.unilateral is None or self.unilateral.agrees)

    @property
    def here(self) -> str:
        return self.claim.here.format(**self.finding.numbers)

    @property
    def reason(self) -> str:
        return self.claim.reason.format(**self.finding.numbers)


def check(runs: Runs) -> Iterator[CheckedClaim]:
    """Check all claims in turn, those on large inputs with joints that lift off as well."""
    lifting = runs.with_unilateral_joints
    for claim in CLAIMS:
        unilateral = None
        if claim.large:
            unilateral = CheckedClaim(claim, claim.find(lifting), RECORDED_UNILATERAL[claim.number])
        yield CheckedClaim(claim, claim.find(runs), RECORDED[claim.number], unilateral)
