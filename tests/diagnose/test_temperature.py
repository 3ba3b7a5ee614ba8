"""Friction that follows the temperature of its test, and what looks like it."""

import numpy as np
import pytest

from tests.diagnose.rigs import FORCE, HEAD, LOOP, PLACE, oscillator, saved
from wedgesweep import api
from wedgesweep.diagnose.diagnosis import data_of, excluded_effects
from wedgesweep.diagnose.evaluation import Point, Scenario
from wedgesweep.errors import InputError

MODEL = oscillator(mass_kg=1.0, spring_N_per_mm=0.2, normal_force_N=10.0)
# Temperatures (deg C) of four tests, and amplitudes (mm), which do not grow with them.
TEMPERATURES, AMPLITUDES = (20.0, 60.0, 35.0, 50.0), (10.0, 15.0, 20.0, 25.0)
SHARE = -0.006
CANDIDATES = ("thermal_drift", "friction_level", "viscous_damping", "cubic_stiffness", "stribeck")


def by_temperature(temperature, velocity):
    """Friction (N) that falls with temperature from the model's at 20 degrees."""
    return 3.0 * (1.0 + SHARE * (temperature - 20.0)) * np.sign(velocity)


def write(folder, friction=by_temperature, temperatures=TEMPERATURES):
    """Loops at 1 Hz with 1 % of noise, one at each temperature (None: not stated)."""
    random, time, omega = np.random.default_rng(4), np.arange(2000) / 500.0, 2.0 * np.pi
    tests = {}
    for temperature, amplitude in zip(temperatures, AMPLITUDES, strict=True):
        x, v = 1e-3 * amplitude * np.sin(omega * time), omega * 1e-3 * amplitude * np.cos(omega * time)
        force = (200.0 - omega**2) * x + friction(temperature, v)
        force = force + 0.01 * force.std() * random.standard_normal(time.size)
        stated = "" if temperature is None else f"temperature_C = {temperature}\n"
        tests[f"at-{amplitude:g}-mm"] = (time, 1e3 * x, force), LOOP + stated
    return saved(folder, MODEL, HEAD + PLACE + FORCE, "t,x,F", tests)


def constant(temperature, velocity):
    return 3.0 * np.sign(velocity)


@pytest.mark.parametrize("reference", [20.0, 10.0])
def test_each_test_is_simulated_at_its_own_temperature(tmp_path, reference):
    """The coefficients of the model are those at the reference that it states."""
    path = write(tmp_path)
    (tmp_path / "model.toml").write_text(f"{MODEL}[effects.thermal_drift]\nreference_C = {reference}\n")
    data = data_of(api.read_measurement(path))
    numbers = {"share": SHARE, "temperature": 20.0, "reference": 20.0}
    point = Point(np.zeros(0), *data.start())
    cold, drift = data.compare(
        [Scenario({}, point), Scenario({"thermal_drift": numbers}, point)], tolerance=1e-6
    )
    # Each with its own share of the friction gone, which is half the height of the loop.
    lost = [
        np.median(np.abs(before - after)[seen])
        for before, after, seen in zip(cold.response, drift.response, data.weight > 0.0, strict=True)
    ]
    by_test = dict(zip(data.names, lost, strict=True))
    found = [max(lost for name, lost in by_test.items() if f"-{a:g}-" in name) for a in AMPLITUDES]
    assert found == pytest.approx([3.0 * -SHARE * (t - reference) for t in TEMPERATURES], rel=0.02, abs=1e-9)


def test_a_candidate_where_temperatures_differ(tmp_path):
    assert "thermal_drift" not in excluded_effects(api.read_measurement(write(tmp_path)))
    for same in ((30.0,) * 4, (None,) * 4):
        excluded = excluded_effects(api.read_measurement(write(tmp_path, constant, same)))
        assert excluded["thermal_drift"] == "shows only where temperature_C differs from test to test"


def test_all_tests_state_their_temperature_or_none(tmp_path):
    with pytest.raises(InputError, match=r"test\[2\].temperature_C: missing; other tests state it"):
        api.read_measurement(write(tmp_path, constant, (20.0, 30.0, None, 40.0)))


@pytest.mark.acceptance
@pytest.mark.parametrize(
    ("friction", "named"),
    [
        (by_temperature, ["thermal_drift"]),
        (lambda temperature, velocity: 1.2 * constant(temperature, velocity), ["friction_level"]),
    ],
)
def test_what_was_hidden_is_named_and_not_its_neighbour(tmp_path, friction, named):
    measurement = api.read_measurement(write(tmp_path, friction))
    found = api.diagnose_measurement(measurement, effects=CANDIDATES, n_jobs=1)
    assert [cause["effect"] for cause in found.causes] == named
    assert found.verdict == "named"
    if "thermal_drift" in named:
        low, high = found.causes[0]["parameters"]["share_per_K"]["ci95"]
        assert low <= SHARE <= high
