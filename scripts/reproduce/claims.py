"""The paper's claims: what each says and its verdict on record, from docs/paper.md, and what checks it."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import dropwhile, takewhile
from pathlib import Path

from reproduce import experiment, laws, sticking, suspension
from reproduce.findings import Finding
from reproduce.runs import Runs

PAGE = Path(__file__).parents[2] / "docs" / "paper.md"
# What comes before the tables of all claims, and of those on inputs so large that joints pull.
ALL, LARGE = "## Claim by claim", "No verdict changes with joints that lift off."
FINDERS = {
    1: suspension.parameters_and_cases,
    2: suspension.rest_position,
    3: suspension.resonance,
    4: suspension.unit_ratio,
    5: laws.same_trend,
    6: sticking.stick_slip,
    7: sticking.onset_of_motion,
    8: laws.lowest_frequency,
    9: laws.regularised_alike,
    10: sticking.sinusoidal,
    11: experiment.shown_cases,
    12: experiment.jump,
    13: experiment.plateaus,
    14: laws.nearer_to_coulomb,
    15: suspension.lift_off,
    16: suspension.like_frictionless,
    17: laws.method,
}


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, its number there in short, and the function that checks it.

    ``recorded`` is the verdict on record: if a run finds another one, something has changed. ``unilateral``
    is that with joints that lift off, for claims on large inputs; None for others.
    """

    number: int
    statement: str
    paper: str
    find: Callable[[Runs], Finding]
    recorded: str
    unilateral: str | None


def _rows(before: str) -> Iterator[list[str]]:
    """Cells of each row of the first table of the page after some words."""
    lines = PAGE.read_text(encoding="utf-8").partition(before)[2].splitlines()
    table = takewhile(lambda line: line.startswith("|"), dropwhile(lambda line: line[:1] != "|", lines))
    for line in list(table)[2:]:
        yield [cell.strip(" *") for cell in line.strip("|").split("|")]


def _on_record() -> Iterator[Claim]:
    lifting = {row[0]: row[-1] for row in _rows(LARGE)}
    for number, statement, paper, _, verdict in _rows(ALL):
        yield Claim(int(number), statement, paper, FINDERS[int(number)], verdict, lifting.get(number))


CLAIMS = tuple(_on_record())


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
