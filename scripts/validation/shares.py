"""Shares of data sets, with Wilson intervals."""

from collections.abc import Callable, Sequence
from math import nan, sqrt
from typing import Any, NamedTuple

# Half width of the 95 % interval of a standard normal distribution.
Z95 = 1.959964


class Share(NamedTuple):
    """``hits`` out of ``n``."""

    hits: int
    n: int

    @property
    def value(self) -> float:
        return self.hits / self.n if self.n else nan

    @property
    def wilson(self) -> tuple[float, float]:
        """95 % interval (Wilson, 1927)."""
        if not self.n:
            return 0.0, 1.0
        p, z = self.value, Z95
        middle = (p + z * z / (2 * self.n)) / (1 + z * z / self.n)
        half = z * sqrt(p * (1 - p) / self.n + z * z / (4 * self.n**2)) / (1 + z * z / self.n)
        return max(middle - half, 0.0), min(middle + half, 1.0)

    def __str__(self) -> str:
        if not self.n:
            return "no sets"
        low, high = self.wilson
        return f"{self.hits:3d}/{self.n:<3d} {self.value:4.0%} [{low:.0%}, {high:.0%}]"


def share(records: Sequence[Any], passes: Callable[[Any], bool]) -> Share:
    """Share of the records that pass a test."""
    return Share(sum(map(passes, records)), len(records))
