"""How a case can end."""

from enum import IntEnum, auto
from typing import Any

# A case has settled if its last two periods differ by less than this share of the input amplitude.
SETTLED = 1e-3


class Outcome(IntEnum):
    """How a case ended; ``str`` gives the name that datasets and messages use."""

    OK = 0
    LOCKED = auto()
    TIME_LIMIT = auto()
    SOLVER_FAILURE = auto()
    NOT_FINITE = auto()
    NOT_RUN = auto()
    WORKER_LOST = auto()

    def __str__(self) -> str:
        return self.name.lower()


def settled(period: Any, periodicity: Any) -> Any:
    """Whether responses repeat; where no period was looked for, whether the last two periods agree.

    The arguments are arrays: the dataset's variables of these names.
    """
    return (period > 0) | ((period < 0) & (periodicity <= SETTLED))
