"""How each case of a sweep ended."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import xarray as xr

from wedgesweep import formatting
from wedgesweep.outcome import Outcome, settled

LIFT_OFF = "lift_off_fraction"
# A variable of unilateral joints.
OPENS = "column_open_fraction"
# Variables of the dataset that Outcomes holds.
COLUMNS = ("status", "period", "periodicity", LIFT_OFF)


class CaseResult(NamedTuple):
    """How one case ended; amplitude in ``unit``, m or N, or "" for the scale of an input.

    ``period``, ``periodicity`` and ``lift_off_fraction`` are the dataset's variables of these names.
    """

    law: str
    beta: float
    amplitude: float
    status: Outcome
    message: str
    period: int
    periodicity: float
    lift_off_fraction: float
    unit: str = "m"

    @property
    def settled(self) -> bool:
        """Whether the case has reached a steady response."""
        return bool(settled(self.period, self.periodicity))

    @property
    def lifted(self) -> bool:
        """Whether a bilateral joint pulled where a real one would open: the model is outside its validity."""
        return self.lift_off_fraction > 0.0

    def __str__(self) -> str:
        where = formatting.case(self.law, self.beta, self.amplitude, self.unit)
        return f"{where}: {self.status}: {self.message}"


@dataclass(frozen=True)
class Outcomes:
    """How cases ended: columns, shape (n,), as a sweep may have millions of cases.

    ``describe_case`` gives law, beta, amplitude, unit and message of one of them.
    """

    status: np.ndarray
    period: np.ndarray
    periodicity: np.ndarray
    lift_off_fraction: np.ndarray
    describe_case: Callable[[int], tuple[str, float, float, str, str]]

    def __len__(self) -> int:
        return len(self.status)

    def __getitem__(self, place: int) -> CaseResult:
        law, beta, amplitude, unit, message = self.describe_case(place)
        return CaseResult(
            law,
            beta,
            amplitude,
            Outcome(self.status[place]),
            message,
            int(self.period[place]),
            float(self.periodicity[place]),
            float(self.lift_off_fraction[place]),
            unit,
        )

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
        """Number of cases that were solved, but lie outside the model's validity."""
        return int(((self.status == Outcome.OK) & (self.lift_off_fraction > 0.0)).sum())


def of_dataset(ds: xr.Dataset) -> Outcomes:
    """How each case of a dataset ended."""
    if LIFT_OFF not in ds or OPENS in ds:  # normal forces are given, or joints may lift off
        ds = ds.assign({LIFT_OFF: xr.zeros_like(ds["status"], float)})
    if "scale" in ds.coords:
        return _of_transients(ds)
    unit = ds["amplitude"].attrs.get("units", "m")
    shape, dims = ds["status"].shape, ds["status"].dims

    def described(place: int) -> tuple[str, float, float, str, str]:
        at = dict(zip(dims, (int(each) for each in np.unravel_index(place, shape)), strict=True))
        case = ds[["friction_law", "beta", "amplitude", "message"]].isel(at)
        law, beta, amplitude, message = (
            case[name].item() for name in ("friction_law", "beta", "amplitude", "message")
        )
        return law, beta, amplitude, unit, message

    columns = {name: ds[name].values.ravel() for name in COLUMNS}
    return Outcomes(**columns, describe_case=described)


def _of_transients(ds: xr.Dataset) -> Outcomes:
    """How each case of a dataset ended whose input does not repeat."""
    shape, nothing = ds["status"].shape, np.zeros(ds["status"].size)

    def described(place: int) -> tuple[str, float, float, str, str]:
        law, scale = np.unravel_index(place, shape)
        case = ds[["friction_law", "scale", "message"]].isel(friction_law=int(law), scale=int(scale))
        return case["friction_law"].item(), 1.0, case["scale"].item(), "", case["message"].item()

    # Nothing has to settle.
    status, lifted = ds["status"].values.ravel(), ds[LIFT_OFF].values.ravel()
    return Outcomes(status, nothing + 1.0, nothing, lifted, described)
