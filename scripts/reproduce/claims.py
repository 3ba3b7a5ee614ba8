"""All claims, checked on the runs."""

from collections.abc import Iterator
from dataclasses import dataclass

from reproduce import experiment, laws, sticking, suspension
from reproduce.findings import Claim, Finding
from reproduce.runs import Runs

TOPICS = (suspension, laws, sticking, experiment)
CLAIMS = tuple(
    sorted(
        (each for topic in TOPICS for each in vars(topic).values() if isinstance(each, Claim)),
        key=lambda claim: claim.number,
    )
)


@dataclass(frozen=True)
class CheckedClaim:
    """A claim with the finding on it, and that with joints that lift off (None where it has none)."""

    claim: Claim
    finding: Finding
    unilateral: Finding | None

    @property
    def agrees(self) -> bool:
        """Whether the verdicts are those on record."""
        lifting = self.unilateral and self.unilateral.verdict
        return (self.finding.verdict, lifting) == (self.claim.recorded, self.claim.unilateral)


def check(runs: Runs) -> Iterator[CheckedClaim]:
    """Check all claims in turn, those on large inputs with joints that lift off as well."""
    lifting = runs.with_unilateral_joints
    for claim in CLAIMS:
        yield CheckedClaim(claim, claim.find(runs), claim.find(lifting) if claim.unilateral else None)
