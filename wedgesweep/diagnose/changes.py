"""What each stage of a diagnosis changed."""

from collections.abc import Sequence
from math import inf, isfinite
from typing import Any, NamedTuple, Protocol

# A fit is better if it takes this much off chi-squared.
SLIGHT = 1.0


class Best(NamedTuple):
    """The effects of the best explanation, and its misfit (penalised, where several are compared)."""

    effects: tuple[str, ...]
    misfit: float


NO_BEST = Best((), inf)


class HasBest(Protocol):
    """What a stage changes."""

    @property
    def best(self) -> Best: ...


class Change(NamedTuple):
    """The best explanation before and after a stage, and the work that this took (see work.py)."""

    stage: str
    before: Best
    after: Best
    work: float

    @property
    def gained(self) -> float:
        """How much less the best explanation leaves."""
        return 0.0 if self.after == self.before else self.before.misfit - self.after.misfit


def summary(changes: Sequence[Change]) -> list[dict[str, Any]]:
    """Stages in the order in which they began, for diagnosis.json; those of many fits are summed up."""
    rows = []
    for stage in dict.fromkeys(each.stage for each in changes):
        own = [each for each in changes if each.stage == stage]
        gained = [each.gained for each in own]
        best = min(own, key=lambda each: each.after.misfit).after.effects
        finite = max(filter(isfinite, gained), default=None)
        rows.append(
            {
                "stage": stage,
                "taken": len(own),
                "better": sum(gain > SLIGHT for gain in gained),
                "most_gained": finite,
                "best": list(best),
                "work": sum(sorted(each.work for each in own)),
            }
        )
    return rows
