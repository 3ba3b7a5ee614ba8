"""How each case of a sweep ended."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from wedgesweep import formatting
from wedgesweep.outcome import Outcome, settled

if TYPE_CHECKING:
    from wedgesweep.config import Case

LIFT_OFF = "lift_off_fraction"
# A variable of unilateral joints.
OPENS = "column_open_fraction"
# Variables of the dataset that Outcomes holds.
COLUMNS = ("status", "period", "periodicity", LIFT_OFF)


@dataclass(frozen=True)
class Outcomes:
    """How cases ended: columns, shape (n,), as a sweep may have millions of cases.

    ``period``, ``periodicity`` and ``lift_off_fraction`` are the dataset's variables of these names;
    ``describe_case`` gives one of the cases, the SI unit of its amplitude ("" for a scale), and its message.
    """

    status: np.ndarray
    period: np.ndarray
    periodicity: np.ndarray
    lift_off_fraction: np.ndarray
    describe_case: Callable[[int], "tuple[Case, str, str]"]

    def __len__(self) -> int:
        return len(self.status)

    def described(self, place: int) -> str:
        """A case, and how it ended."""
        case, unit, message = self.describe_case(place)
        return f"{formatting.case(*case, unit=unit)}: {Outcome(self.status[place])}: {message}"

    @property
    def counts(self) -> dict[Outcome, int]:
        """Number of cases with each outcome that occurs, the most frequent first."""
        numbers = np.bincount(self.status, minlength=len(Outcome)).tolist()
        found = {outcome: numbers[outcome] for outcome in Outcome if numbers[outcome]}
        return dict(sorted(found.items(), key=lambda item: -item[1]))

    @cached_property
    def failures(self) -> np.ndarray:
        """Places of cases that failed."""
        return np.flatnonzero(self.status != Outcome.OK)

    @property
    def unsettled(self) -> int:
        """Number of cases that were solved, but did not reach a steady response."""
        return int(((self.status == Outcome.OK) & ~settled(self.period, self.periodicity)).sum())

    @property
    def lifted(self) -> int:
        """Number of solved cases in which bilateral joints pull, outside of the model's validity."""
        return int(((self.status == Outcome.OK) & (self.lift_off_fraction > 0.0)).sum())


def of_dataset(ds: xr.Dataset) -> Outcomes:
    """How each case of a dataset ended."""
    if LIFT_OFF not in ds or OPENS in ds:  # normal forces are given, or joints may lift off
        ds = ds.assign({LIFT_OFF: xr.zeros_like(ds["status"], float)})
    scaled = "scale" in ds.coords
    size = "scale" if scaled else "amplitude"
    unit = "" if scaled else ds[size].attrs.get("units", "m")
    keys = {name: ds[name].attrs["key"] for name in ds.coords if "key" in ds[name].attrs}
    names = ["friction_law", *(["beta"] * (not scaled)), size, "message", *keys]
    shape, dims = ds["status"].shape, ds["status"].dims

    def described(place: int) -> "tuple[Case, str, str]":
        # It takes a second to load, and most sweeps have no case to name.
        from wedgesweep.config import Case

        at = dict(zip(dims, (int(each) for each in np.unravel_index(place, shape)), strict=True))
        here = ds[names].isel(at)
        found = {name: here[name].item() for name in names}
        numbers = tuple((key, found[name]) for name, key in keys.items())
        case = Case(found["friction_law"], found.get("beta", 1.0), found[size], numbers)
        return case, unit, found["message"]

    columns = {name: ds[name].values.ravel() for name in COLUMNS if name in ds}
    if scaled:  # nothing has to settle
        nothing = np.zeros(ds["status"].size)
        columns |= {"period": nothing + 1.0, "periodicity": nothing}
    return Outcomes(**columns, describe_case=described)
