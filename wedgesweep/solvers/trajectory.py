"""What every solver returns: the kept part of a run, as points in time."""

from dataclasses import dataclass
from math import pi

import numpy as np


@dataclass(frozen=True)
class Window:
    """Time span of a run (s): from 0 to ``end``, of which the part from ``keep`` on is kept.

    ``keep`` is a whole number of forcing periods, so that the kept part starts at phase 0 of the input;
    ``periods`` are kept, with ``samples_per_period`` samples on an even grid.
    """

    omega: float
    settle_periods: int
    periods: int
    samples_per_period: int

    @property
    def keep(self) -> float:
        return 2.0 * pi / self.omega * self.settle_periods

    @property
    def end(self) -> float:
        return 2.0 * pi / self.omega * (self.settle_periods + self.periods)

    @property
    def sample_times(self) -> np.ndarray:
        steps = np.arange(self.periods * self.samples_per_period) / self.samples_per_period
        return 2.0 * pi / self.omega * (self.settle_periods + steps)


@dataclass(frozen=True, eq=False)
class TimedWindow(Window):
    """A window with sample times of one's own: ``offsets`` (s, increasing, shape (n,)) from ``keep``."""

    offsets: np.ndarray

    @property
    def sample_times(self) -> np.ndarray:
        return self.keep + self.offsets


@dataclass(frozen=True)
class Samples:
    """States at the sample times of the kept window.

    ``t`` (s), ``x`` (m, deflection from rest) and ``velocity`` (m/s) have shape (n,); ``contact`` holds the
    five numbers of ``damper.Contact`` in each row, shape (n, 5), ``normal`` the normal forces on column and
    bolster (N; NaN while stuck), shape (2, n).
    """

    t: np.ndarray
    x: np.ndarray
    velocity: np.ndarray
    contact: np.ndarray
    normal: np.ndarray


def empty_samples(times: np.ndarray) -> Samples:
    """Room for samples at some times (s)."""
    n = times.size
    return Samples(times, np.empty(n), np.empty(n), np.empty((n, 5), np.int8), np.empty((2, n)))


@dataclass(frozen=True)
class Trajectory:
    """Kept window of a run: its samples, and the running sums over it (tally.TALLY, shape (1,))."""

    samples: Samples
    tally: np.ndarray
    periods: int
    statistics: dict[str, int]


class CaseError(Exception):
    """A case that has no answer; ``status`` is one of dataset.STATUSES."""

    def __init__(self, message: str, status: str) -> None:
        super().__init__(message)
        self.status = status
