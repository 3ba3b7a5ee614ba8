"""A clock that counts simulations instead of seconds, and a budget by it.

What a search tries is then the same on every machine, with any number of threads. The unit is the work of
simulating one forcing period of the base model; each thread has a clock of its own.
"""

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Generic, NamedTuple, TypeVar

Result = TypeVar("Result")


class _Clock(threading.local):
    reading = 0.0


_clock = _Clock()


def done() -> float:
    """Work that counts for this thread so far."""
    return _clock.reading


def add(work: float) -> None:
    """Count work for this thread, whichever thread has done it."""
    _clock.reading += work


class Piece(NamedTuple, Generic[Result]):
    """What a function returned, and the work that it took."""

    result: Result
    work: float


def apart(function: Callable[[], Result]) -> Piece[Result]:
    """Call a function whose work is returned, and counted for no thread yet."""
    begun = done()
    result = function()
    piece = Piece(result, done() - begun)
    _clock.reading = begun
    return piece


class Untried(NamedTuple):
    """What a search left out: how many of how many, and the effects of each."""

    what: str
    left_out: int
    of: int
    effects: tuple[tuple[str, ...], ...] = ()


@dataclass
class Budget:
    """Work that may be spent from now on by this thread and by those that work for it.

    ``untried``: what there was no work left for; ``tried``: combinations of effects that were fitted.
    """

    total: float = float("inf")
    begun: float = field(default_factory=done)
    untried: list[Untried] = field(default_factory=list)
    tried: set[frozenset[str]] = field(default_factory=set)

    @property
    def left(self) -> float:
        return self.total - (done() - self.begun)

    def grant(self, work: float) -> None:
        """Raise the budget, if necessary, so that this much work is left."""
        self.total = max(self.total, done() - self.begun + work)

    def ended(self, what: str, done: int, effects: Sequence[tuple[str, ...]]) -> None:
        """Remember which of some combinations of effects were tried, the first ones, and which were not."""
        self.tried.update(map(frozenset, effects[:done]))
        if done < len(effects):
            self.untried.append(Untried(what, len(effects) - done, len(effects), tuple(effects[done:])))

    @property
    def never_tried(self) -> tuple[tuple[str, ...], ...]:
        """Pairs of effects that were left out whenever it was their turn, in that order."""
        left_out = {frozenset(each): each for one in self.untried for each in one.effects if len(each) > 1}
        return tuple(each for names, each in left_out.items() if names not in self.tried)
