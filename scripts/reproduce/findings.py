"""The finding on a claim: numbers compared by stated criteria, and the verdict that follows."""

from dataclasses import dataclass

VERDICTS = ("holds", "partly", "contradicted", "not testable")
HOLDS, PARTLY, CONTRADICTED, NOT_TESTABLE = VERDICTS
# Criteria that several claims share: amplitude ratio above which the bolster moves, higher harmonics over the
# fundamental of a distorted response, share of time stuck of one that sticks.
MOVES, DISTORTED, STICKS = 1e-3, 0.1, 0.01


@dataclass(frozen=True)
class Check:
    """One statement of a claim; ``holds`` is None where the runs cannot decide it."""

    statement: str
    here: float | None
    criterion: str
    holds: bool | None


def near(statement: str, here: float, expected: float, within: float) -> Check:
    """Check that a number differs from the expected one by at most the share ``within`` of it."""
    criterion = f"{expected:.6g} +- {within:.2%}" if within else f"{expected:.6g}"
    return Check(statement, here, criterion, bool(abs(here - expected) <= within * abs(expected)))


def below(statement: str, here: float, limit: float) -> Check:
    """Check that a number is at most the limit."""
    return Check(statement, here, f"at most {limit:.6g}", bool(here <= limit))


def above(statement: str, here: float, limit: float) -> Check:
    """Check that a number is more than the limit."""
    return Check(statement, here, f"more than {limit:.6g}", bool(here > limit))


def untested(statement: str, why: str) -> Check:
    """State what the runs cannot decide, and why."""
    return Check(statement, None, why, None)


@dataclass(frozen=True)
class Finding:
    """What the runs say on a claim: their numbers in short, the reason, and the checks that decide."""

    here: str
    reason: str
    checks: tuple[Check, ...]

    @property
    def verdict(self) -> str:
        """Whether all tested statements hold, some or none."""
        tested = [check.holds for check in self.checks if check.holds is not None]
        if not tested:
            return NOT_TESTABLE
        if all(tested):
            return HOLDS
        return PARTLY if any(tested) else CONTRADICTED
