"""The paper's cases with joints that lift off, where its own joints pull."""

from math import inf

import numpy as np
import xarray as xr

from wedgesweep.reproduce.runs import MM, Run
from wedgesweep.reproduce.single_case import changed
from wedgesweep.sweep import variables
from wedgesweep.sweep.cases import solve_cases

# As in claim 15: inputs and frequencies far above those at which nothing opens.
LARGE_MM, LARGE_BETA, ROUNDING = 1.0, 1.0, 1e-6
UNILATERAL = {"suspension": {"joints": "unilateral"}, "solver": {"method": "event-driven"}}
KEPT = ("amplitude_ratio", "lift_off_fraction", "impacts", "impact_energy", "dissipated_energy")


def opened(run: Run) -> xr.Dataset:
    """The run's cases with unilateral joints: some variables; NaN where a case failed."""
    config = changed(run.config, UNILATERAL)
    dtype = variables.record_dtype({"phase": 0, "harmonic": variables.HARMONICS, "part": 2})
    cases = config.records()
    found = solve_cases(cases, np.arange(len(cases)), config.solver, inf, dtype)
    shape, coordinates = config.case_coordinates()
    numbers = {name: (variables.GRID, found[name].reshape(shape)) for name in KEPT}
    return xr.Dataset(numbers, coordinates)


def large(ds: xr.Dataset) -> xr.DataArray:
    """Whether each case has a large input above resonance."""
    return (ds["amplitude"] * MM > LARGE_MM - ROUNDING) & (ds["beta"] > LARGE_BETA - ROUNDING)


def changes(held: xr.Dataset, opens: xr.Dataset) -> dict[str, float]:
    """What lift-off changes: shares of cases and of time, amplitude ratios, and what impacts take."""
    lifts = opens["lift_off_fraction"] > 0.0
    share = opens["lift_off_fraction"].where(large(opens))
    change = (opens["amplitude_ratio"] / held["amplitude_ratio"]).where(lifts)
    taken = opens["impact_energy"] / (opens["impact_energy"] + opens["dissipated_energy"])
    return {
        "open_cases": float(lifts.mean()),
        "open_low": float(share.min()),
        "open_high": float(share.max()),
        "held_peak": float(held["amplitude_ratio"].max()),
        "open_peak": float(opens["amplitude_ratio"].max()),
        "least_change": float(change.min()),
        "most_change": float(change.max()),
        "median_change": float(change.median()),
        "struck": float(taken.where(large(opens)).median()),
    }
