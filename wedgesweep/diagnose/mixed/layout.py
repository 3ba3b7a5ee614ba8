"""Rows of the tests, and columns of the nuisance parameters, of each kind among those of all kinds.

Tests of one kind follow those of another. Nuisance parameters of each kind have columns of their own, as a
step of one must not move another: first come those with a prior, kind by kind, then all others.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from wedgesweep.diagnose.evaluation import WarmStart
from wedgesweep.diagnose.fit_data import FitData


class MixedStart(NamedTuple):
    """Where simulations of the tests of each kind start from; None for a kind without tests."""

    parts: tuple[WarmStart | None, ...]
    layout: "Layout"

    def of(self, rows: Any) -> "MixedStart":
        own = self.layout.split(rows)
        parts = [
            None if part is None or not each.size else part.of(each)
            for part, each in zip(self.parts, own, strict=True)
        ]
        return MixedStart(tuple(parts), self.layout.subset(rows))

    def where(self, chosen: np.ndarray, other: "MixedStart") -> "MixedStart":
        pairs = zip(self.layout.parted(chosen), self.parts, other.parts, strict=True)
        parts = tuple(None if mine is None else mine.where(own, its) for own, mine, its in pairs)
        return MixedStart(parts, self.layout)


@dataclass(frozen=True)
class Layout:
    """Of each part: its tests, its nuisance parameters with a prior (P), and all of them (N)."""

    tests: tuple[int, ...]
    priors: tuple[int, ...]
    nuisances: tuple[int, ...]

    @classmethod
    def of(cls, parts: Sequence[FitData]) -> "Layout":
        return cls(
            tuple(part.tests for part in parts),
            tuple(part.nuisance_std.shape[1] for part in parts),
            tuple(part.start()[0].shape[1] for part in parts),
        )

    @cached_property
    def rows(self) -> tuple[slice, ...]:
        """Tests of each part among all."""
        ends = np.cumsum(self.tests)
        return tuple(slice(int(end) - size, int(end)) for end, size in zip(ends, self.tests, strict=True))

    @cached_property
    def columns(self) -> tuple[np.ndarray, ...]:
        """Columns of the nuisance parameters of each part among all."""
        first = np.cumsum([0, *self.priors])
        rest = sum(self.priors) + np.cumsum([0, *np.subtract(self.nuisances, self.priors)])
        return tuple(
            np.r_[first[i] : first[i + 1], rest[i] : rest[i + 1]].astype(int) for i in range(len(self.tests))
        )

    def split(self, rows: Any) -> list[np.ndarray]:
        """Some tests, as indices of the tests of each part."""
        places = np.arange(sum(self.tests))[rows]
        return [places[(places >= own.start) & (places < own.stop)] - own.start for own in self.rows]

    def parted(self, values: np.ndarray) -> list[np.ndarray]:
        """Values (T, ...) of all tests as those of each part."""
        return [values[own] for own in self.rows]

    def subset(self, rows: Any) -> "Layout":
        """The layout of some of the tests; columns stay as they are."""
        return Layout(tuple(each.size for each in self.split(rows)), self.priors, self.nuisances)

    def joined_rows(self, parts: Sequence[np.ndarray]) -> np.ndarray:
        """Values (..., t, m) of the parts that have tests as (..., T, m), with zeros at the end."""
        shape = parts[0].shape[:-2]
        found = np.zeros(
            (*shape, sum(each.shape[-2] for each in parts), max(each.shape[-1] for each in parts))
        )
        first = 0
        for each in parts:
            found[..., first : first + each.shape[-2], : each.shape[-1]] = each
            first += each.shape[-2]
        return found

    def joined_columns(
        self, parts: Sequence[np.ndarray | None], elsewhere: float, priors: bool = False
    ) -> np.ndarray:
        """Values (t, N) of each part as (T, sum of N), or if ``priors`` (t, P) as (T, sum of P).

        Columns of other parts are ``elsewhere``.
        """
        width = sum(self.priors) if priors else sum(self.nuisances)
        found = np.full((sum(self.tests), width), elsewhere)
        for rows, columns, own, size in zip(self.rows, self.columns, parts, self.priors, strict=True):
            if own is not None:
                found[rows, columns[: size if priors else None]] = own
        return found
