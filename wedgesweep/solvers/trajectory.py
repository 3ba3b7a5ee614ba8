"""What every solver returns: the kept part of a run, as points in time."""

from collections.abc import Sequence
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


@dataclass(frozen=True)
class Points:
    """States along a run.

    ``t`` (s), ``x`` (m, deflection from rest), ``velocity`` (m/s) and ``weight`` (s) have shape (n,); ``contact``
    holds the five numbers of ``damper.Contact`` in each row, shape (n, 5).
    """

    t: np.ndarray
    x: np.ndarray
    velocity: np.ndarray
    weight: np.ndarray
    contact: np.ndarray

    @classmethod
    def joined(cls, parts: Sequence["Points"]) -> "Points":
        columns = ("t", "x", "velocity", "weight", "contact")
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in columns))


@dataclass(frozen=True)
class Trajectory:
    """Kept window of a run.

    ``samples`` lie on an even grid of the forcing phase (their weights are 0). The weights of ``nodes``
    integrate smooth functions over the window, piece by piece; nodes of weight 0 mark where a piece
    begins or ends and where x is extreme.
    """

    samples: Points
    nodes: Points
    statistics: dict[str, int]


class CaseError(Exception):
    """A case that has no answer; ``status`` is one of dataset.STATUSES."""

    def __init__(self, status: str, message: str) -> None:
        super().__init__(message)
        self.status = status
