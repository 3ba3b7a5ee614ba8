"""How a case can end."""

from enum import IntEnum, auto


class Outcome(IntEnum):
    """How a case ended; ``str`` gives the name that datasets and messages use."""

    OK = 0
    LOCKED = auto()
    TIME_LIMIT = auto()
    SOLVER_FAILURE = auto()
    NOT_FINITE = auto()
    NOT_RUN = auto()

    def __str__(self) -> str:
        return self.name.lower()
