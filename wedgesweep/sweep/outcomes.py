"""How each case of a dataset ended; places count its cases in the order of its dimensions."""

import numpy as np
import xarray as xr

from wedgesweep import formatting
from wedgesweep.outcome import Outcome


def counts(ds: xr.Dataset) -> dict[Outcome, int]:
    """Number of cases with each outcome that occurs, the most frequent first."""
    numbers = np.bincount(ds["status"].values.ravel(), minlength=len(Outcome)).tolist()
    found = {outcome: numbers[outcome] for outcome in Outcome if numbers[outcome]}
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def failures(ds: xr.Dataset) -> np.ndarray:
    """Places of the cases that failed."""
    return np.flatnonzero(~np.isin(ds["status"], (Outcome.OK, Outcome.NOT_RUN)))


def described(ds: xr.Dataset, place: int) -> str:
    """A case in words, and how it ended."""
    at = np.unravel_index(place, ds["status"].shape)
    here = ds.isel({dim: int(i) for dim, i in zip(ds["status"].dims, at, strict=True)})
    size = "scale" if "scale" in ds.coords else "amplitude"
    unit = "" if size == "scale" else ds[size].attrs.get("units", "m")
    beta = 1.0 if size == "scale" else here["beta"].item()
    numbers = [(ds[name].attrs["key"], here[name].item()) for name in ds.coords if "key" in ds[name].attrs]
    case = formatting.case(here["friction_law"].item(), beta, here[size].item(), numbers, unit)
    return f"{case}: {Outcome(here['status'].item())}: {here['message'].item()}"
