"""A clock that counts simulations instead of seconds, and a budget by it.

What a search tries is then the same on every machine, with any number of threads. The unit is the work of
simulating one forcing period of the base model; each thread has a clock of its own. A time limit ends a
search earlier: every simulation looks at it.
"""

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

# A fit is better if it takes this much off chi-squared.
SLIGHT = 1.0


class Best(NamedTuple):
    """The effects of the best explanation, and its misfit (penalised, where several are compared)."""

    effects: tuple[str, ...]
    misfit: float


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


Result = TypeVar("Result")


# Share of a time limit after which nothing is added to a search: intervals and held-out tests take time, too.
SEARCH_SHARE = 0.5
# What ends a search before it has tried everything.
SPENT, TIME_LIMIT = "budget", "time limit"


class OutOfTime(KeyboardInterrupt):
    """The time limit is reached; no handler of errors takes it for one."""


def unlimited() -> float:
    """Share of the time that is used up where there is no limit."""
    return 0.0


class _Clock(threading.local):
    """Of each thread: its work, what stages changed, and the share of the time limit that is used up.

    From a share of 1 on, simulations raise OutOfTime.
    """

    def __init__(self) -> None:
        self.reading, self.changes = 0.0, list[Change]()
        self.time_used: Callable[[], float] = unlimited


_clock = _Clock()


def time_used() -> Callable[[], float]:
    """The function that tells this thread which share of its time limit is used up."""
    return _clock.time_used


@contextmanager
def limited(used: Callable[[], float]) -> Iterator[None]:
    """A time limit for the simulations of this thread; ``used`` returns the share that is used up."""
    before, _clock.time_used = _clock.time_used, used
    try:
        yield
    finally:
        _clock.time_used = before


def done() -> float:
    """Work that counts for this thread so far."""
    return _clock.reading


def add(work: float) -> None:
    """Count work for this thread, whichever thread has done it; raises OutOfTime beyond a time limit."""
    _clock.reading += work
    if _clock.time_used() >= 1.0:
        raise OutOfTime


def told(change: Change) -> None:
    """Keep what a stage changed."""
    _clock.changes.append(change)


class Uncounted(NamedTuple, Generic[Result]):
    """What a function returned, its work and what its stages changed, which no thread has counted yet."""

    result: Result
    work: float
    changes: list[Change]


def uncounted(function: Callable[[], Result]) -> Uncounted[Result]:
    """Call a function without counting its work for this thread; ``count`` does so later."""
    begun, changes, _clock.changes = done(), _clock.changes, []
    try:
        result = function()
        outcome = Uncounted(result, done() - begun, _clock.changes)
    finally:
        _clock.changes = changes
    _clock.reading = begun
    return outcome


def count(outcomes: Sequence[Uncounted[Result]]) -> None:
    """Count work for this thread, and keep what changed."""
    _clock.changes += [change for each in outcomes for change in each.changes]
    add(sum(each.work for each in outcomes))


class Untried(NamedTuple):
    """What a search left out: how many of how many, the effects of each, and what ended it."""

    what: str
    left_out: int
    of: int
    effects: tuple[tuple[str, ...], ...]
    ended_by: str


@dataclass
class Budget:
    """Work that this thread, and those that work for it, may spend from now on.

    ``total``: in the unit of the clock; ``begun``: reading of the clock at which the budget began;
    ``told_before``: number of changes that were told before;
    ``untried``: what the budget, or the time, was too small for; ``tried``: combinations of effects that were
    fitted.
    """

    total: float = float("inf")
    begun: float = field(default_factory=done)
    told_before: int = field(default_factory=lambda: len(_clock.changes))
    untried: list[Untried] = field(default_factory=list)
    tried: set[frozenset[str]] = field(default_factory=set)

    @property
    def changes(self) -> list[Change]:
        """What stages changed since the budget began."""
        return _clock.changes[self.told_before :]

    @property
    def left(self) -> float:
        return self.total - (done() - self.begun)

    def grant(self, work: float) -> None:
        """Raise the budget, if necessary, so that this much work is left."""
        self.total = max(self.total, done() - self.begun + work)

    def ended(self, what: str, count: int, effects: Sequence[tuple[str, ...]]) -> None:
        """Record that the first ``count`` of some combinations of effects were tried, the others not.

        If work is left, it was the time that ended the search.
        """
        self.tried.update(map(frozenset, effects[:count]))
        if count < len(effects):
            left_out, why = tuple(effects[count:]), TIME_LIMIT if self.left > 0.0 else SPENT
            self.untried.append(Untried(what, len(left_out), len(effects), left_out, why))

    @property
    def never_tried(self) -> tuple[tuple[str, ...], ...]:
        """Pairs of effects that were left out whenever it was their turn, in that order."""
        left_out = {frozenset(each): each for one in self.untried for each in one.effects if len(each) > 1}
        return tuple(each for names, each in left_out.items() if names not in self.tried)


class Step(str):
    """A step in words that also holds the stage, and how many of its parts are done."""

    __slots__ = ("done", "stage", "total")

    stage: str
    done: int
    total: int

    def __new__(cls, stage: str, done: int, total: int) -> "Step":
        step = super().__new__(cls, f"{stage}: {done} of {total}")
        step.stage, step.done, step.total = stage, done, total
        return step
