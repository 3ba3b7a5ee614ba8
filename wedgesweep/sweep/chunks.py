"""Chunks of a sweep's cases for the jobs, made one at a time: cases are counted, not listed.

Cases that depend on each other form a row: in a continuation all frequencies of otherwise equal cases, else
each case is a row by itself.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import prod

import numpy as np

# The event-driven solver takes CHUNK cases at a time, which also go into the journal together; a small
# sweep is divided into CHUNKS smaller chunks.
CHUNK, CHUNKS = 200, 64


@dataclass(frozen=True)
class Rows:
    """The rows of a sweep whose axes have the sizes ``shape``; ``along``: the axis of a row, if any."""

    shape: tuple[int, ...]
    along: int | None = None

    @property
    def width(self) -> int:
        """Number of cases of a row."""
        return 1 if self.along is None else self.shape[self.along]

    @property
    def stride(self) -> int:
        """Difference between the indices of neighbours in a row."""
        return 1 if self.along is None else prod(self.shape[self.along + 1 :])

    @property
    def count(self) -> int:
        """Number of rows."""
        return prod(self.shape) // self.width

    def cases(self, rows: np.ndarray) -> np.ndarray:
        """Indices of the cases of some rows, shape (n, width)."""
        before, after = np.divmod(rows[:, None], self.stride)
        return (before * self.width + np.arange(self.width)) * self.stride + after

    def of(self, indices: np.ndarray) -> np.ndarray:
        """Row that each case belongs to."""
        before, after = np.divmod(indices, self.width * self.stride)
        return before * self.stride + after % self.stride

    def complete(self, indices: np.ndarray) -> np.ndarray:
        """Rows all of whose cases are among these different ones, in increasing order."""
        rows, cases = np.unique(self.of(indices), return_counts=True)
        return rows[cases == self.width]

    def without(self, rows: np.ndarray) -> Sequence[int] | np.ndarray:
        """All other rows; where none are left out they are not listed."""
        if not rows.size:
            return range(self.count)
        left = np.ones(self.count, bool)
        left[rows] = False
        return np.flatnonzero(left)

    def chunks(self, rows: Sequence[int] | np.ndarray, method: str) -> Iterator[np.ndarray]:
        """Divide rows into the chunks that jobs solve: one row for Radau, many for the event-driven solver.

        A chunk takes rows from all over the grid: the cost of a case varies along the grid, so that chunks of
        neighbours would leave some jobs idle at the end.
        """
        size = min(CHUNK, -(-len(rows) * self.width // CHUNKS)) if method == "event-driven" else 1
        count = -(-len(rows) // max(size // self.width, 1))
        return (np.array(rows[first::count]) for first in range(count))
