"""Compares an empirical force with the force that was hidden."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from validation import hidden_force
from wedgesweep.figures.diagnosis.marks import STDS

# Where there are at least so many samples over those of an average cell, data are dense.
DENSE = 0.5
# What a model may leave of tests left out, over their noise, and the share of the dense cells in which the
# true force lies in the 95 % band.
MOST_LEFT, LEAST_IN_BAND = 1.5, 0.9
STAGE, FILE = "empirical force", "diagnosis.nc"


def told(result: Path, hidden: dict[str, dict[str, float]], level: float) -> dict[str, Any] | None:
    """What a campaign keeps of an empirical force; None if the diagnosis had none.

    ``level``: noise of the records over their rms. ``left``: what the extended model leaves of records
    left out, over their noise; ``named_left``: what the best named explanation leaves; ``work``: that of
    the diagnosis over that without the force; ``in_band``: share of the dense cells with the true force
    in the band; ``error``: rms error in them over the true force's rms.
    """
    document = json.loads((result / "diagnosis.json").read_text())
    found = document["empirical_force"]
    if found is None:
        return None
    work = {each["stage"]: each["work"] for each in document["stages"]}
    kept = {
        "offered": found["offered"],
        "left": _left(found["accuracy_held_out"], level),
        "named_left": _left(found["named"]["accuracy_held_out"], level),
        "freedom": found["degrees_of_freedom"],
        "work": sum(work.values()) / (sum(work.values()) - work.get(STAGE, 0.0)),
    }
    numbers = hidden.get(hidden_force.EFFECT.name)
    if found["offered"] and numbers is not None:
        with xr.open_dataset(result / FILE) as data:
            kept |= _shape(data, numbers)
    return kept


def _left(accuracy: float | None, level: float) -> float | None:
    """Error and noise together over the noise."""
    return None if accuracy is None else float(np.hypot(accuracy, level) / level)


def _shape(data: xr.Dataset, numbers: dict[str, float]) -> dict[str, float]:
    density = data["missing_force_density"].values
    truth = hidden_force.on_mass(numbers, data["force_place"].values, data["force_speed"].values)
    measured = ~np.isnan(data["missing_force"].values)
    truth = truth - np.average(truth[measured], weights=density[measured])
    error = data["missing_force"].values - truth
    dense = density >= DENSE
    within = np.abs(error[dense]) <= STDS * data["missing_force_std"].values[dense]
    return {
        "in_band": float(within.mean()),
        "error": float(np.sqrt((error[dense] ** 2).mean() / (truth[dense] ** 2).mean())),
    }


def extends(record: dict[str, Any]) -> bool:
    """Whether an offered force leaves no more than MOST_LEFT times the noise of tests left out."""
    found = record["empirical_force"]
    return bool(found and found["offered"] and found["left"] <= MOST_LEFT)


def shows_shape(record: dict[str, Any]) -> bool:
    """Whether the true force lies in the band of an offered one over LEAST_IN_BAND of the dense cells."""
    found = record["empirical_force"]
    return bool(found and found["offered"] and found["in_band"] >= LEAST_IN_BAND)


def not_offered(record: dict[str, Any]) -> bool:
    found = record["empirical_force"]
    return found is None or not found["offered"]


def cheap(record: dict[str, Any]) -> bool:
    """Whether the diagnosis takes at most twice the simulations of one without the force."""
    found = record["empirical_force"]
    return found is None or found["work"] <= 2.0
