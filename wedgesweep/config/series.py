"""Lists of values: of names, and of numbers that increase."""

from collections import Counter
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from wedgesweep.config.keys import Choice, Key, Number, Whole
from wedgesweep.config.tables import Table, table
from wedgesweep.hints import show


def spaced(start: float, stop: float, num: int, spacing: str) -> list[float]:
    """Values of a range, rounded to 12 digits; the ends are exact."""
    space = np.geomspace if spacing == "log" else np.linspace
    inner = [float(f"{value:.12g}") for value in space(start, stop, num)[1:-1]]
    return [start, *inner, stop][:num]


@dataclass(frozen=True, kw_only=True)
class Several(Key):
    """A list of different values of one kind; a single value is a list of one."""

    item: Choice | Number

    def read(self, value: Any, path: str, problems: list[str]) -> list[Any] | None:
        given = value if isinstance(value, list) else [value]
        if not given:
            problems.append(f"{path}: the list is empty; write at least one value")
        places = [f"{path}[{i}]" for i in range(len(given))] if given is value else [path]
        values = [self.item.read(each, place, problems) for each, place in zip(given, places, strict=True)]
        faults = self._faults([each for each in values if each is not None])
        problems.extend(f"{path}: {fault}" for fault in faults)
        return None if faults or not values or None in values else values

    def _faults(self, values: list[Any]) -> list[str]:
        """Faults of the list as a whole."""
        repeated = [each for each, times in Counter(values).items() if times > 1]
        return [f"{show(each)} is repeated; keep one" for each in repeated]

    def shape(self) -> dict[str, Any]:
        item = self.item.shape()
        array = {"type": "array", "items": item, "minItems": 1, "uniqueItems": True}
        return {"anyOf": [item, array]}


@dataclass(frozen=True, kw_only=True)
class Series(Several):
    """Increasing numbers: a list, or a range { start, stop, num, spacing }."""

    item: Number

    @property
    def range(self) -> "Table":
        """The keys of a range."""
        start, stop = (
            Number(key=key, meaning=meaning, quantity=replace(self.item.quantity, key=key), example=example)
            for key, meaning, example in (("start", "first value", 0.1), ("stop", "last value", 3.0))
        )
        num = Whole.new("num", "number of values", minimum=1, maximum=10_000, example=30)
        spacing = Choice("spacing", "equal steps or ratios", default="linear", choices=("linear", "log"))
        return table(self.key, self.meaning, start, stop, num, spacing)

    def read(self, value: Any, path: str, problems: list[str]) -> list[float] | None:
        if isinstance(value, dict):
            return self._expanded(value, path, problems)
        return super().read(value, path, problems)

    def _faults(self, values: list[Any]) -> list[str]:
        falls = [
            f"{other} follows {one}; write the values in increasing order"
            for one, other in pairwise(values)
            if other < one
        ]
        return super()._faults(values) + falls

    def _expanded(self, value: Any, path: str, problems: list[str]) -> list[float] | None:
        before = len(problems)
        given = self.range.read(value, path, problems)
        if len(problems) > before:
            return None
        values = spaced(**given)
        if values[-1] == given["stop"] and all(one < other for one, other in pairwise(values)):
            return values
        wrong = "{num} increasing values do not lead from {start} to {stop}".format(**given)
        problems.append(f"{path}: {wrong}; write start < stop and num > 1, or a single number")
        return None

    def shape(self) -> dict[str, Any]:
        return {"anyOf": [*super().shape()["anyOf"], self.range.shape()]}


@dataclass(frozen=True, kw_only=True)
class Numbers(Key):
    """Numbers, or names, that may repeat, in any order."""

    item: Number | Choice

    def read(self, value: Any, path: str, problems: list[str]) -> list[Any] | None:
        given = value if isinstance(value, list) else [value]
        read = [self.item.read(each, f"{path}[{i}]", problems) for i, each in enumerate(given)]
        known = [each for each in read if each is not None]
        return known if len(known) == len(read) else None

    def shape(self) -> dict[str, Any]:
        return {"type": "array", "items": self.item.shape(), "minItems": 1}
