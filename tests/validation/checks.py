"""Checks of a diagnosis that several tests share."""

import pytest
import xarray as xr
from validation.judge import NAMING

from tests.validation.laboratory import diagnose, make
from wedgesweep.diagnosis_result import DATASET

# True numbers lie within twice the 95 % interval (4 standard deviations).
WIDER = 2.0


def numbers_are_near_truth(found, effects):
    for name, numbers in effects.items():
        for key, true in numbers.items():
            estimate = found.parameters[f"{name}.{key}"]
            low, high = estimate["ci95"]
            middle, half = 0.5 * (low + high), 0.5 * (high - low)
            assert abs(true - middle) <= WIDER * half, f"{name}.{key}: {true} against {estimate}"


def strong_cause_is_named(specimen, here, candidates=None):
    measured, truth = make(specimen, here)
    found = diagnose(measured, here / "found", candidates, "--no-report")
    assert found.document["misfit"]["excess_base"] >= 800.0
    assert found.verdict in NAMING
    assert found.causes == set(truth["effects"])
    numbers_are_near_truth(found, truth["effects"])
    assert found.document["misfit"]["p_extended"] > 1e-3
    assert found.document["gain"]["excess_removed"] > 0.8
    with xr.open_dataset(found.directory / DATASET) as ds:
        energy = ds["simulated_energy"].sel(model="extended") / ds["measured_energy"]
        if "fixture_resonance" in truth["effects"]:  # data of a side frame whose input nobody knows
            assert energy.isnull().all()
        else:
            assert float(energy.median()) == pytest.approx(1.0, abs=0.02)
