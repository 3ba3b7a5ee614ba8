"""All claims, the verdicts that are on record, and how each claim comes out."""

from collections.abc import Iterator
from dataclasses import dataclass

from wedgesweep.reproduce import experiment, integration, laws, oscillator, sticking, suspension
from wedgesweep.reproduce.findings import CONTRADICTED, HOLDS, PARTLY, Claim, Finding
from wedgesweep.reproduce.runs import Runs

TOPICS = (suspension, laws, sticking, oscillator, experiment, integration)
CLAIMS = tuple(
    sorted(
        (each for topic in TOPICS for each in vars(topic).values() if isinstance(each, Claim)),
        key=lambda claim: claim.number,
    )
)

# Verdict of each claim by its number. A run that finds another one has found a change.
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


@dataclass(frozen=True)
class Outcome:
    """A claim, what was found, and the verdict on record."""

    claim: Claim
    finding: Finding
    recorded: str

    @property
    def verdict(self) -> str:
        return self.finding.verdict

    @property
    def agrees(self) -> bool:
        return self.verdict == self.recorded

    @property
    def here(self) -> str:
        return self.claim.here.format(**self.finding.numbers)

    @property
    def reason(self) -> str:
        return self.claim.reason.format(**self.finding.numbers)


def check(runs: Runs) -> Iterator[Outcome]:
    """Check all claims, one after the other."""
    for claim in CLAIMS:
        yield Outcome(claim, claim.find(runs), RECORDED[claim.number])
