"""How a case can end, and what makes the numbers of a solved one doubtful."""

from enum import IntEnum, auto
from typing import Any

# A case has settled if its last two periods differ by less than this share of the input amplitude.
SETTLED = 1e-3
# Variables of a dataset: share of time with lift-off, and one that only joints have which may open.
LIFT_OFF, OPENS = "lift_off_fraction", "column_open_fraction"


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


def unsettled(ds: Any) -> Any:
    """Whether each solved case of a dataset was still changing when it ended."""
    if not {"period", "periodicity"} <= set(ds.variables):  # of an input that does not repeat
        return ds["status"] != ds["status"]
    return (ds["status"] == Outcome.OK) & ~settled(ds["period"], ds["periodicity"])


def lifted(ds: Any) -> Any:
    """Whether a held joint pulls in each case of a dataset, where a real one would lift off."""
    if LIFT_OFF not in ds or OPENS in ds:
        return ds["status"] != ds["status"]
    return ds[LIFT_OFF] > 0.0
