"""The three laws on the same cases, and cases that failed, have not settled or lift off."""

from collections.abc import Iterable
from itertools import combinations
from typing import Any

import numpy as np
import xarray as xr

from reproduce.runs import LAWS, Run, Runs
from wedgesweep.outcome import SETTLED
from wedgesweep.sweep import outcomes
from wedgesweep.sweep.variables import STATUSES

# Ranges of the input over the amplitude at which set-valued friction begins to slip.
NEAR = 5.0
ZONES = {"below breakaway": (0.0, 1.0), "near breakaway": (1.0, NEAR), "beyond": (NEAR, np.inf)}
# A case is far from settled if its last two periods differ by more than this share of the input amplitude.
FAR_FROM_SETTLED = 0.1


def spread(run: Run, laws: Iterable[str] = LAWS) -> xr.DataArray:
    """Range of the amplitude ratios of some laws over the largest of them."""
    ratios = run.ds["amplitude_ratio"].sel(friction_law=list(laws))
    largest = ratios.max("friction_law", skipna=False)
    smallest = ratios.min("friction_law", skipna=False)
    moves = largest != 0.0
    return ((largest - smallest) / largest.where(moves)).where(moves, 0.0).where(largest.notnull())


def zone(run: Run, name: str) -> xr.DataArray:
    """Whether a case lies in one of ``ZONES``, over beta and amplitude."""
    low, high = ZONES[name]
    level = run.ds["amplitude"] / run.onset
    return (level >= low) & (level < high)


def settled(run: Run) -> xr.DataArray:
    """Whether a case has settled under every law, over beta and amplitude."""
    return (run.ds["periodicity"] <= SETTLED).all("friction_law")


def _summary(values: xr.DataArray) -> dict[str, float]:
    stacked = values.stack(case=("beta", "amplitude")).dropna("case")
    if not stacked.size:
        return {"cases": 0}
    largest = stacked[int(stacked.values.argmax())]
    return {
        "cases": int(stacked.size),
        "median": float(stacked.median()),
        "largest": float(largest),
        "largest_at_beta": float(largest["beta"]),
        "largest_at_amplitude_mm": 1e3 * float(largest["amplitude"]),
    }


def laws(run: Run) -> list[dict[str, Any]]:
    """Difference of the amplitude ratio of each pair of laws: all cases, then zone by zone."""
    return [
        {"laws": list(pair), "inputs": name, **_summary(values)}
        for pair in combinations(LAWS, 2)
        for name, values in _by_zone(run, spread(run, pair)).items()
    ]


def _by_zone(run: Run, values: xr.DataArray) -> dict[str, xr.DataArray]:
    return {"all": values, **{name: values.where(zone(run, name)) for name in ZONES}}


def caveats(runs: Runs) -> list[dict[str, Any]]:
    """Per run and law: number of cases, of failures, of cases not settled and of cases with lift-off."""
    return [_caveat(name, run, law) for name, run in runs.named.items() for law in LAWS]


def failed_cases(runs: Runs) -> list[str]:
    """Each failed case in words."""
    found = {name: outcomes.of_dataset(run.ds) for name, run in runs.named.items()}
    return [f"{name}: {own[place]}" for name, own in found.items() for place in own.failures.tolist()]


def _caveat(name: str, run: Run, law: str) -> dict[str, Any]:
    ds = run.law(law)
    status = ds["status"].values
    lifted = ds["lift_off_fraction"]
    return {
        "run": name,
        "law": law,
        "cases": int(status.size),
        "failed": {
            word: int((status == number).sum())
            for number, word in enumerate(STATUSES)
            if number and (status == number).any()
        },
        "not_settled": int((ds["periodicity"] > SETTLED).sum()),
        "far_from_settled": int((ds["periodicity"] > FAR_FROM_SETTLED).sum()),
        "lift_off": int((lifted > 0.0).sum()),
        "largest_lift_off_fraction": float(lifted.max()),
    }
