"""Friction of an oscillator whose normal force differs from test to test: parts of it, told apart."""

from pathlib import Path

import numpy as np
import pytest

from tests.diagnose.rigs import FORCE, HEAD, LOOP, oscillator, saved
from wedgesweep import api
from wedgesweep.diagnose.diagnosis import excluded_effects
from wedgesweep.errors import InputError

MODEL = oscillator(mass_kg=1.0, spring_N_per_mm=0.2, normal_force_N=10.0, contact="ground")
ABSOLUTE = 'displacement = { column = "x", unit = "mm", of = "absolute" }\n'
RECORDED = 'normal_force = { column = "n", unit = "N", zero_std = 0.02 }\n'
LOADS, SAME = (5.0, 10.0, 20.0, 40.0), (10.0, 10.0)
CANDIDATES = ("guide_friction", "load_dependent_friction", "friction_level", "viscous_damping")
PART, EXPONENT = 1.5, 1.0 / 3.0


def constant_part(normal: float) -> float:
    """Friction (N) of a constant and a proportional part."""
    return 0.3 * normal + PART


def falling(normal: float) -> float:
    """Friction (N) whose coefficient falls with load from the model's at its own normal force."""
    return 0.3 * normal * (normal / 10.0) ** -EXPONENT


def write(folder: Path, friction, loads=LOADS, sensor=None) -> Path:
    """Loops at 1 Hz and 20 mm under each load (N), with 1 % of noise.

    ``sensor``: load (n,) as recorded at times (s) in place of a stated one.
    """
    random, time, omega = np.random.default_rng(3), np.arange(3000) / 500.0, 2.0 * np.pi
    tests = {}
    for load in dict.fromkeys(loads):
        x = 0.02 * np.sin(omega * time)
        force = (200.0 - omega**2) * x + friction(load) * np.sign(np.cos(omega * time))
        force = force + 0.01 * force.std() * random.standard_normal(time.size)
        shown = np.zeros(time.size) if sensor is None else sensor(load, time)
        stated = "" if sensor else f'model = {{ "oscillator.normal_force_N" = {load} }}\n'
        tests[load] = (time, 1e3 * x, force, shown), LOOP + stated
    head = HEAD + ABSOLUTE + FORCE + (RECORDED if sensor else "")
    return saved(folder, MODEL, head, "t,x,F,n", tests)


@pytest.mark.acceptance
@pytest.mark.parametrize(
    ("friction", "effect", "key", "true"),
    [
        (constant_part, "guide_friction", "force_N", PART),
        (falling, "load_dependent_friction", "exponent", EXPONENT),
    ],
)
def test_the_part_of_friction_that_was_hidden_is_named(tmp_path, friction, effect, key, true):
    measurement = api.read_measurement(write(tmp_path, friction))
    found = api.diagnose_measurement(measurement, effects=CANDIDATES, n_jobs=1)
    assert (found.verdict, [cause["effect"] for cause in found.causes]) == ("named", [effect])
    low, high = found.causes[0]["parameters"][key]["ci95"]
    assert low <= true <= high


def test_candidates_need_loads_that_differ(tmp_path):
    several = excluded_effects(api.read_measurement(write(tmp_path, constant_part)))
    assert not {"guide_friction", "load_dependent_friction"} & several.keys()
    one = excluded_effects(api.read_measurement(write(tmp_path, constant_part, SAME)))
    assert one["guide_friction"].startswith("is friction_level")
    assert one["load_dependent_friction"].startswith("shows only where")
    assert one["preload"] == "acts on no part of it"


def test_a_recorded_load_is_that_of_the_model(tmp_path):
    """Its mean, whatever the noise; loads that hardly differ tell nothing of what depends on them."""
    random = np.random.default_rng(5)
    path = write(tmp_path, constant_part, sensor=lambda load, t: load + 0.1 * random.standard_normal(t.size))
    found = api.read_measurement(path)
    loads = [found.model_of(test).oscillator["normal_force"] for test in found.tests]
    assert loads == pytest.approx(LOADS, abs=0.01)
    assert all(test.normal_force is None for test in found.tests)
    assert not {"guide_friction", "load_dependent_friction"} & excluded_effects(found).keys()
    near = write(tmp_path, constant_part, (10.0, 10.2), sensor=lambda load, t: np.full(t.size, load))
    assert "guide_friction" in excluded_effects(api.read_measurement(near))


@pytest.mark.parametrize(
    ("sensor", "told"),
    [
        (lambda load, t: -load + 0.0 * t, "what rubs presses; write sign = -1"),
        (lambda load, t: load * (1.0 + 0.05 * t), "moves from 5 to 6.5 N, and the model has one load"),
        (lambda load, t: 0.01 * load + 0.0 * t, "zero_std of more than 5%"),
    ],
)
def test_records_that_are_no_load_of_the_model_are_refused(tmp_path, sensor, told):
    with pytest.raises(InputError, match=told):
        api.read_measurement(write(tmp_path, constant_part, sensor=sensor))
