"""An empirical force as it is stored: numbers, the map for figures, and a config with its table."""

from typing import Any

import numpy as np
import xarray as xr

from wedgesweep.config import force_table
from wedgesweep.diagnose.diagnosis import Diagnosis
from wedgesweep.diagnose.empirical.stage import EmpiricalForce
from wedgesweep.diagnose.result.extended_config import written
from wedgesweep.diagnosis_result import FORCE_CONFIG, FORCE_TABLE
from wedgesweep.effects.empirical_force import NAME, PLACES, SPEEDS

MAP, DENSITY = ("force_place", "force_speed"), "samples over those of an average cell"
HEADING = "# Verdict: {verdict}. The base model with the force that it lacks, as a table.\n"


def document(force: EmpiricalForce | None) -> dict[str, Any] | None:
    """The part of diagnosis.json; None where no force was fitted."""
    if force is None:
        return None
    own, named = force.fit.hypothesis, force.named
    place, speed = force.next_place
    offered = {
        "step_N": force.step if own.step else None,
        "nearest": [
            {"form": each.name, "share": each.share, "ci95": list(each.interval)} for each in force.nearest
        ],
        "next_place": {"displacement_mm": 1e3 * place, "velocity_mm_per_s": 1e3 * speed},
    }
    return {
        "offered": force.offered,
        "accuracy": force.accuracy,
        "accuracy_held_out": force.held_out,
        "named": {
            "effects": list(named.effects),
            "accuracy": named.accuracy,
            "accuracy_held_out": named.held_out,
        },
        "degrees_of_freedom": force.fit.freedom,
        **(offered if force.offered else {}),
    }


def with_map(stored: xr.Dataset, force: EmpiricalForce | None) -> xr.Dataset:
    """A dataset with the map of an offered force; NaN where nothing was measured."""
    if force is None or not force.offered:
        return stored
    own = force.map
    shown: dict[str, tuple[Any, np.ndarray, str, str]] = {
        "missing_force": (MAP, np.where(own.measured, own.force, np.nan), "N", "force that is missing"),
        "missing_force_std": (MAP, own.std, "N", "its standard deviation"),
        "missing_force_density": (MAP, own.density, "1", DENSITY),
    }
    for axis, over in enumerate(("speed", "place")):
        mean, std = own.over(axis)
        dims = (f"force_{over}",)
        shown[f"missing_force_over_{over}"] = (dims, mean, "N", f"force that is missing over {over}")
        shown[f"missing_force_over_{over}_std"] = (dims, std, "N", "its standard deviation")
    return stored.assign(
        {
            name: (dims, values, {"units": unit, "long_name": meaning})
            for name, (dims, values, unit, meaning) in shown.items()
        }
    ).assign_coords(force_place=own.places, force_speed=own.speeds)


def files(found: Diagnosis) -> dict[str, str]:
    """Texts of the config with an offered force and of its table, by file."""
    force = found.empirical
    if force is None or not force.offered:
        return {}
    numbers: dict[str, Any] = {name: each for name, each in force.values().items() if name != NAME}
    own, table = force.fit.hypothesis.ranges, force.values()[NAME][force_table.TABLE]
    forces = np.reshape(np.array(table, float), (PLACES, SPEEDS))
    heading = HEADING.format(verdict=found.finding.verdict)
    tables = {NAME: {force_table.FILE: FORCE_TABLE}}
    return {
        FORCE_CONFIG: heading + written(found, force.fit.as_fit, numbers, tables),
        FORCE_TABLE: force_table.written(
            1e3 * own.displacement, 1e3 * own.velocity, 1e3 * own.centre, forces
        ),
    }
