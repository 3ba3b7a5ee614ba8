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
    """A window with given sample times: ``offsets`` (s, increasing, shape (n,)) from ``keep``."""

    offsets: np.ndarray

    @property
    def sample_times(self) -> np.ndarray:
        return self.keep + self.offsets


@dataclass(frozen=True)
class TransientWindow(Window):
    """A window that is one period of length ``span`` (s): that of an input which does not repeat."""

    span: float

    @property
    def keep(self) -> float:
        return 0.0

    @property
    def end(self) -> float:
        return self.span

    @property
    def sample_times(self) -> np.ndarray:
        return np.arange(self.samples_per_period) * (self.span / self.samples_per_period)


@dataclass(frozen=True)
class Samples:
    """States at the sample times of the kept window.

    ``t`` (s), ``x`` (m, displacement from rest) and ``velocity`` (m/s) have shape (n,), ``sticks`` (n,)
    says whether the observed contact sticks, ``normal`` (2, n) holds the normal forces of both contacts
    (N; NaN while not determined), ``acceleration`` (n,) the rate of the velocity (m/s^2), or has shape (0,).
    """

    t: np.ndarray
    x: np.ndarray
    velocity: np.ndarray
    sticks: np.ndarray
    normal: np.ndarray
    acceleration: np.ndarray


def empty_samples(times: np.ndarray) -> Samples:
    """Room for samples at some times (s)."""
    n = times.size
    return Samples(times, np.empty(n), np.empty(n), np.zeros(n, np.bool_), np.empty((2, n)), np.empty(n))


@dataclass(frozen=True)
class Trajectory:
    """Kept window of a run: its samples, and the running sums over it (accumulators.SUMS, shape (1,))."""

    samples: Samples
    sums: np.ndarray
    periods: int
    statistics: dict[str, int]


class CaseError(Exception):
    """A case that has no answer; ``status`` is one of variables.STATUSES."""

    def __init__(self, message: str, status: str) -> None:
        super().__init__(message)
        self.status = status
