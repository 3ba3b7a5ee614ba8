"""What joints that lift off change in the paper's cases, where its own joints pull."""

import xarray as xr

from reproduce.runs import MM

# As in claim 15: inputs and frequencies far above those at which nothing opens.
LARGE_MM, LARGE_BETA, ROUNDING = 1.0, 1.0, 1e-6


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
