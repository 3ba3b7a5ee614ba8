"""Effects hidden in synthetic data are found through the command line; where nothing is, nothing is named.

A quick part of the validation campaign (``make validate``).
"""

import pytest
import xarray as xr

from tests.validation.laboratory import BENCH, PAPER, Hidden, diagnose, make
from wedgesweep.diagnosis_result import DATASET, EXTENDED, JSON
from wedgesweep.effects import EFFECTS

NAMED = ("named", "consistent-with")
UNCERTAIN = {"friction_level": 0.07}
SINGLES = (
    Hidden("guide", "static-dynamic", {"guide_friction": {"force_N": 0.25}}, "ar1"),
    Hidden(
        "lag", "exponential", {"velocity_lag": {"time_s": 4e-4}}, "adc", uncertain={"friction_level": 0.07}
    ),
    Hidden(
        "tone",
        "static-dynamic",
        {"stray_vibration": {"acceleration_m_per_s2": 1.0, "frequency_hz": 47.3}},
        "adc",
        tests=BENCH[::2],  # what does not repeat takes long to simulate
        uncertain={"friction_level": 0.07},
    ),
    Hidden("spring", "coulomb", {"cubic_stiffness": {"coefficient_N_per_mm3": 0.6}}, "differentiated"),
    Hidden("fixture", "static-dynamic", {"fixture_resonance": {"frequency_hz": 90.0, "damping_ratio": 0.1}}),
)
PAIR = Hidden(
    "pair",
    "exponential",
    {"viscous_damping": {"coefficient_N_s_per_m": 6.0}, "displacement_gain": {"scale": 1.06}},
)
CLEAN = Hidden("clean", "static-dynamic", {}, "ar1", uncertain=UNCERTAIN, spread=0.02)
WITHHELD = Hidden(
    "withheld",
    "static-dynamic",
    {"column_compliance": {"stiffness_N_per_mm": 60.0}},
    withheld=("column_compliance",),
)
POOR = Hidden("paper", "static-dynamic", {"guide_friction": {"force_N": 0.25}}, tests=PAPER, spread=None)
# True numbers lie within twice the 95 % interval (4 standard deviations).
WIDER = 2.0


def assert_near_truth(found, effects):
    for name, numbers in effects.items():
        for key, true in numbers.items():
            estimate = found.parameters[f"{name}.{key}"]
            low, high = estimate["ci95"]
            middle, half = 0.5 * (low + high), 0.5 * (high - low)
            assert abs(true - middle) <= WIDER * half, f"{name}.{key}: {true} against {estimate}"


@pytest.mark.parametrize("hidden", [*SINGLES, PAIR], ids=lambda hidden: hidden.name)
def test_a_strong_cause_is_named_with_its_numbers(hidden, tmp_path):
    measured, truth = make(hidden, tmp_path)
    found = diagnose(measured, tmp_path / "found")
    assert found.document["misfit"]["excess_base"] >= 800.0
    assert found.verdict in NAMED
    assert found.causes == set(truth["effects"])
    assert_near_truth(found, truth["effects"])
    assert found.document["misfit"]["p_extended"] > 1e-3
    assert found.document["gain"]["excess_removed"] > 0.8
    with xr.open_dataset(found.directory / DATASET) as ds:
        energy = ds["simulated_energy"].sel(model="extended") / ds["measured_energy"]
        if "fixture_resonance" in truth["effects"]:  # data of a side frame whose input nobody knows
            assert energy.isnull().all()
        else:
            assert float(energy.median()) == pytest.approx(1.0, abs=0.02)


def test_in_clean_data_nothing_is_named(tmp_path):
    measured, _ = make(CLEAN, tmp_path)
    found = diagnose(measured, tmp_path / "found")
    assert found.verdict == "nothing-missing"
    assert found.document["causes"] == []
    assert (found.directory / "report.html").exists()
    again = diagnose(measured, found.directory, ["displacement_gain"], "--no-report")
    assert len(again.document["candidates"]) < len(found.document["candidates"])
    assert {file.name for file in again.directory.iterdir()} == {JSON, DATASET, EXTENDED}


def test_what_is_not_in_the_library_is_not_named(tmp_path):
    measured, _ = make(WITHHELD, tmp_path)
    candidates = [name for name in EFFECTS if name not in WITHHELD.withheld]
    found = diagnose(measured, tmp_path / "found", candidates)
    assert found.document["misfit"]["excess_base"] >= 800.0
    assert found.verdict in ("none-of-mine", "tied", "data-insufficient")


def test_two_tests_of_unknown_amplitude_ask_for_a_third(tmp_path):
    measured, _ = make(POOR, tmp_path)
    found = diagnose(measured, tmp_path / "found")
    assert found.verdict in ("data-insufficient", "tied")
    following = found.document["next_test"]
    assert following["frequency_hz"] > 0.0
    assert following["amplitude_mm"] > 0.0
