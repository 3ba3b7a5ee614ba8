"""Synthetic transients and loops, from tests.toml to a verdict."""

import json

import numpy as np
import pytest

from tests.command import invoke
from tests.diagnose import test_transients
from wedgesweep import api
from wedgesweep.config import parse
from wedgesweep.measured import read
from wedgesweep.synthesize.plan import PlannedTest
from wedgesweep.synthesize.transients import transient

RIG = test_transients.OSCILLATOR
HIDDEN = "[effects.viscous_damping]\ncoefficient_N_s_per_m = 3.0\n"
RELEASES = """
[[test]]
kind = "transient"
release_mm = 10.0
duration_s = 3.0
[[test]]
kind = "transient"
release_mm = -6.0
release_mm_per_s = 50.0
duration_s = 3.0
"""
SWEEP = """
[[test]]
kind = "transient"
motion = "sweep"
frequency_hz = 1.0
to_hz = 5.0
amplitude_mm = 4.0
duration_s = 12.0
"""
LOOP = """
[[test]]
kind = "loop"
frequency_hz = 1.1
amplitude_mm = 10.0
duration_s = 8.0
"""


def made(folder, plan, effects="", *options):
    """Synthetic data in a folder; returns the path of measured.toml."""
    (folder / "rig.toml").write_text(RIG + effects)
    (folder / "tests.toml").write_text(plan)
    out = folder / "data"
    paths = (folder / "rig.toml", "--tests", folder / "tests.toml", "-o", out)
    invoke("synthesize", *paths, "--n-jobs", 1, *options)
    return out / "measured.toml"


@pytest.mark.acceptance
def test_a_release_starts_where_it_is_told_to(tmp_path):
    first, second = read(made(tmp_path, RELEASES, "", "--level", "0")).tests
    assert [test.kind for test in (first, second)] == ["transient"] * 2
    offset = first.displacement[-10:].mean()
    assert first.displacement[0] - offset == pytest.approx(0.01, rel=0.15)
    assert second.velocity[0] == pytest.approx(0.05, rel=1e-3)


@pytest.mark.acceptance
def test_releases_a_sweep_and_a_loop_in_one_measurement(tmp_path):
    path = made(tmp_path, RELEASES + SWEEP + LOOP, HIDDEN, "--level", "0.01", "--sampling-hz", "250")
    measurement = read(path)
    assert [test.kind for test in measurement.tests] == ["transient"] * 3 + ["loop"]
    assert [test.input is None for test in measurement.tests] == [True, True, False, True]
    assert np.abs(measurement.tests[2].input).max() == pytest.approx(4e-3, rel=0.05)
    found = api.diagnose_measurement(measurement, effects=["viscous_damping", "cubic_stiffness"], n_jobs=1)
    assert [each["effect"] for each in found.causes] == ["viscous_damping"]
    value = found.causes[0]["parameters"]["coefficient_N_s_per_m"]["value"]
    assert value == pytest.approx(3.0, rel=0.05)
    told = json.loads((path.parent / "truth.json").read_text())
    assert [each["kind"] for each in told["tests"]] == ["transient"] * 3 + ["loop"]


RANDOM = SWEEP.replace('"sweep"', '"random"')
FAULTS = {
    "to_hz: missing": SWEEP.replace("to_hz = 5.0\n", ""),
    "release_mm: 0": '[[test]]\nkind = "transient"\n',
    'release_mm: "2" is not a finite number': '[[test]]\nkind = "transient"\nrelease_mm = "2"\n',
    "frequency_hz: missing": LOOP.replace("frequency_hz = 1.1\n", ""),
    "to_hz: 0.5 is not above frequency_hz = 1": RANDOM.replace("to_hz = 5.0", "to_hz = 0.5"),
    "duration_s: 0.2 s are too short for a band of 4 Hz": RANDOM.replace("12.0", "0.2"),
    "duration_s: 0.001 s have 0 samples; at least 64": SWEEP.replace("12.0", "0.001"),
    "duration_s: 0.002 s have 0 samples; at least 64": LOOP.replace("8.0", "0.002"),
}


@pytest.mark.parametrize("message", FAULTS)
def test_a_plan_that_cannot_be_made_says_why(tmp_path, message):
    (tmp_path / "rig.toml").write_text(RIG)
    (tmp_path / "tests.toml").write_text(FAULTS[message])
    paths = (tmp_path / "rig.toml", "--tests", tmp_path / "tests.toml", "-o", tmp_path / "data")
    assert f"tests.toml: test[0].{message}" in invoke("synthesize", *paths, code=2)
    assert not (tmp_path / "data").exists()


LOCKS = """
[friction]
static = 0.29
dynamic = 0.29
[suspension]
bolster_mass_kg = 14.6571
wedge_mass_kg = 4.03934
side_frame_mass_kg = 11.6343
bolster_spring_N_per_mm = 2.36518
wedge_spring_N_per_mm = 1.44404
wedge_angle_deg = 35.369
column_angle_deg = 4.6825
[sweep]
friction_law = "coulomb"
beta = 1.0
amplitude_mm = 0.1
"""
BY_LOAD = "[effects.load_dependent_friction]\nexponent = 0.0914367\n"


@pytest.mark.parametrize(
    ("plan", "effects", "message"),
    [
        pytest.param(
            SWEEP.replace("4.0", "60.0"),
            BY_LOAD,
            "test[0] (transient): normal forces not unique at t = ",
            marks=pytest.mark.acceptance,
        ),
        (LOOP.replace("10.0", "60.0"), "", "test[0] (loop): no force drives the mass in "),
    ],
)
def test_a_test_in_which_a_wedge_locks_is_refused(tmp_path, plan, effects, message):
    (tmp_path / "rig.toml").write_text(LOCKS + effects)
    (tmp_path / "tests.toml").write_text(plan)
    out = tmp_path / "data"
    paths = (tmp_path / "rig.toml", "--tests", tmp_path / "tests.toml", "-o", out)
    found = invoke("synthesize", *paths, "--n-jobs", 1, code=2)
    assert message in found
    assert "Traceback" not in found
    assert not out.exists()


@pytest.mark.acceptance
def test_the_lag_of_a_velocity_channel_is_that_of_the_motion_between_the_samples_too():
    # A mass on a spring, released at rest; the lag, tau y' = v - y from y = 0, is as long as a sample.
    omega, travel, rate, lag = 250.0**0.5, 0.01, 50.0, 0.02
    model = test_transients.OSCILLATOR.replace("damping_N_s_per_m = 1.0", "damping_N_s_per_m = 0.0")
    config = parse(model.replace("normal_force_N = 1.0", "normal_force_N = 0.0"), "model")
    test = PlannedTest(0.0, 0.0, "mm", 0.0, True, "transient", "release", 2.0, None, 1e3 * travel)
    effects = {"velocity_lag": {"time": lag}}
    found = transient(config, "coulomb", effects, test, rate, np.random.default_rng(0))
    t = np.arange(found.velocity.size) / rate
    seen = np.sin(omega * t) - omega * lag * (np.cos(omega * t) - np.exp(-t / lag))
    expected = -travel * omega * seen / (1.0 + (omega * lag) ** 2)
    assert found.displacement == pytest.approx(travel * np.cos(omega * t), abs=1e-6 * travel)
    assert found.velocity == pytest.approx(expected, abs=1e-5 * travel * omega)


def test_a_test_is_made_at_its_temperature(tmp_path):
    """At the reference it is the base model; 50 K above it a drift of -2 % per kelvin leaves no friction."""
    plan = LOOP + "temperature_C = 20.0\n" + LOOP + "temperature_C = 70.0\n"
    drift = "[effects.thermal_drift]\nshare_per_K = -0.02\n"
    without = tmp_path / "without"
    without.mkdir()
    exact = ("--level", "0", "--sampling-hz", "100")
    cold, hot = read(made(tmp_path, plan, drift, *exact)).tests
    (nominal,) = read(made(without, LOOP, "", *exact)).tests
    key = "effects.thermal_drift.temperature_C"
    assert [test.model[key] for test in (cold, hot)] == [20.0, 70.0]
    np.testing.assert_array_equal(cold.force, nominal.force)
    assert np.ptp(cold.force - hot.force) / 2.0 == pytest.approx(0.3, rel=0.01)
