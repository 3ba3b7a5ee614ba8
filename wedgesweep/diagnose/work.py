"""A clock that counts simulations instead of seconds, and a budget by it.

What a search tries is then the same on every machine, with any number of threads. The unit is the work of
simulating one forcing period of the base model; each thread has a clock of its own.
"""

import threading
from collections.abc import Callable
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
    """What a search left out: how many of how many."""

    what: str
    left_out: int
    of: int


@dataclass
class Budget:
    """Work that may be spent from now on by this thread and by those that work for it."""

    total: float = float("inf")
    begun: float = field(default_factory=done)
    untried: list[Untried] = field(default_factory=list)

    @property
    def left(self) -> float:
        return self.total - (done() - self.begun)

    def grant(self, work: float) -> None:
        """See to it that so much is left, whatever was spent before."""
        self.total = max(self.total, done() - self.begun + work)

    def leave_out(self, what: str, left_out: int, of: int) -> None:
        """Remember what there was no work left for."""
        if left_out:
            self.untried.append(Untried(what, left_out, of))
