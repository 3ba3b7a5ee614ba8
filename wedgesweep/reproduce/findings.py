"""What a claim comes to: numbers compared by a stated criterion, and the verdict that follows."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from wedgesweep.reproduce.runs import Runs

HOLDS, PARTLY, CONTRADICTED, NOT_TESTABLE = VERDICTS = (
    "holds",
    "partly",
    "contradicted",
    "not testable",
)


@dataclass(frozen=True)
class Check:
    """One statement of a claim; ``holds`` is None where the runs cannot tell."""

    statement: str
    here: float | None
    criterion: str
    holds: bool | None


def near(statement: str, here: float, expected: float, within: float) -> Check:
    """Check a number against another, ``within`` as a share of that."""
    criterion = f"{expected:.6g}, give or take {within:.2%}" if within else f"{expected:.6g}"
    return Check(statement, here, criterion, bool(abs(here - expected) <= within * abs(expected)))


def below(statement: str, here: float, limit: float) -> Check:
    """Check that a number is at most the limit."""
    return Check(statement, here, f"at most {limit:.6g}", bool(here <= limit))


def above(statement: str, here: float, limit: float) -> Check:
    """Check that a number is more than the limit."""
    return Check(statement, here, f"more than {limit:.6g}", bool(here > limit))


def untested(statement: str, why: str) -> Check:
    """State what the runs cannot tell, and why."""
    return Check(statement, None, why, None)


@dataclass(frozen=True)
class Finding:
    """The checks of a claim, and the numbers that its texts quote."""

    checks: tuple[Check, ...]
    numbers: Mapping[str, float]

    @property
    def verdict(self) -> str:
        """All tested statements hold, none does, or some do."""
        tested = [check.holds for check in self.checks if check.holds is not None]
        if not tested:
            return NOT_TESTABLE
        if all(tested):
            return HOLDS
        return PARTLY if any(tested) else CONTRADICTED


@dataclass(frozen=True)
class Claim:
    """A claim of the paper and what checks it.

    ``words`` and ``paper`` are the paper's statement and number in short; ``here`` and
    ``reason`` are templates that the numbers of the finding fill in.
    """

    number: int
    words: str
    paper: str
    here: str
    reason: str
    find: Callable[[Runs], Finding]


def claim(
    number: int, words: str, *, paper: str, here: str, reason: str
) -> Callable[[Callable[[Runs], Finding]], Claim]:
    """Make a claim of the function that checks it."""
    return lambda find: Claim(number, words, paper, here, reason, find)
