"""Transients whose response is an acceleration, made by Radau: free and driven, both systems."""

import numpy as np
import pytest

from tests.diagnose.answers import diagnosed, is_told
from tests.diagnose.rigs import HEAD, TRANSIENT, saved
from tests.diagnose.test_transients import OSCILLATOR, WEDGE
from wedgesweep.config import parse
from wedgesweep.diagnose.diagnosis import data_of
from wedgesweep.diagnose.next_test.transients import releases
from wedgesweep.diagnose.search import Search, base_fit
from wedgesweep.effects import merge
from wedgesweep.measured import MeasuredError, read
from wedgesweep.synthesize.plan import PlannedTest
from wedgesweep.synthesize.transients import transient

# Rig, hidden effect, travel (mm), sampling rate (Hz), noise (m/s^2); then releases over the travel.
RIGS = {
    "oscillator": (OSCILLATOR, {"viscous_damping": {"coefficient": 2.0}}, 12.0, 500.0, 0.01),
    "wedge": (WEDGE, {"friction_level": {"scale": 1.2}}, 1.0, 1500.0, 0.02),
}
RELEASES = (1.0, -0.7, 0.5)
CANDIDATES = ["viscous_damping", "friction_level", "bolster_stiffness"]
CHANNEL = 'acceleration = {{ column = "a", unit = "m/s^2"{} }}\n'


def made(rig, test, rate, effects):
    config = parse(rig, "model")
    random = np.random.default_rng(2)
    return transient(config, "coulomb", merge(config.effects, effects), test, rate, random)


def write(folder, rig, tables, columns):
    """Files of tests; returns the path of measured.toml."""
    header = ",".join(("t", "a", "u")[: len(tables[0])])
    tests = {f"t{i}": (table, TRANSIENT) for i, table in enumerate(tables)}
    return saved(folder, rig, HEAD + columns, header, tests)


@pytest.mark.acceptance
def test_a_cause_is_named_from_an_accelerometer_on_a_mass_that_is_released(tmp_path):
    rig, effects, travel, rate, noise = RIGS["oscillator"]
    rng, tables = np.random.default_rng(1), []
    for share in RELEASES:
        test = PlannedTest(0.0, 0.0, "mm", 0.0, True, "transient", "release", 2.0, None, share * travel)
        a = made(rig, test, rate, effects).acceleration
        # An accelerometer that does not stand upright shows a share of gravity.
        tables.append([np.arange(a.size) / rate, a + 0.3 + noise * rng.standard_normal(a.size)])
    path = write(tmp_path, rig, tables, CHANNEL.format(""))
    found = diagnosed(path, CANDIDATES)
    is_told(found, effects, 0.03)
    assert list(found.data["channel"].values) == ["acceleration"]


@pytest.mark.acceptance
def test_a_next_release_is_offered_for_the_accelerometer_that_is_there(tmp_path):
    rig, effects, travel, rate, noise = RIGS["oscillator"]
    test = PlannedTest(0.0, 0.0, "mm", 0.0, True, "transient", "release", 2.0, None, travel)
    run = made(rig, test, rate, effects)
    a = run.acceleration + noise * np.random.default_rng(1).standard_normal(run.acceleration.size)
    path = write(tmp_path, rig, [[np.arange(a.size) / rate, a]], CHANNEL.format(""))
    base = base_fit(Search.of(data_of(read(path)), [])).base
    known = base.model.data.sensors()
    assert known.orders == (2,)
    assert known.displacement_noise < 0.03 * 1e-3 * travel
    offered = releases(base, known).data
    assert all(own.orders == (2,) for own in offered.windows)
    # Beside the motion noise is about as small as it was.
    assert (offered.power > 30.0 * offered.observations).all()


@pytest.mark.acceptance
def test_the_acceleration_against_the_ground_under_a_sweep(tmp_path):
    """Where mass and base each carry an accelerometer."""
    rig, effects, travel, rate, noise = RIGS["wedge"]
    natural = 1.0 / (2.0 * np.pi * parse(rig, "model").natural_units(1e-3 * travel).time)
    test = PlannedTest(
        0.6 * natural, 0.2 * travel, "mm", 0.0, True, "transient", "sweep", 20.0 / natural, 1.8 * natural
    )
    run = made(rig, test, rate, effects)
    time = np.arange(run.input.size) / rate
    turns = 0.6 * natural * time + 1.2 * natural * time**2 / (40.0 / natural)
    rate_of = 2.0 * np.pi * (0.6 * natural + 1.2 * natural * time / (20.0 / natural))
    bend = 2.0 * np.pi * 1.2 * natural / (20.0 / natural)
    base = 0.2e-3 * travel * (bend * np.cos(2.0 * np.pi * turns) - rate_of**2 * np.sin(2.0 * np.pi * turns))
    rng = np.random.default_rng(3)
    # The suspension's motion is that of the side frame less that of the bolster.
    absolute = base - run.acceleration
    u = base + 1e-3 * base.std() * rng.standard_normal(time.size)
    table = [time, absolute + noise * rng.standard_normal(time.size), u]
    columns = CHANNEL.format(', of = "absolute"')
    columns += 'input = { column = "u", unit = "m/s^2", quantity = "acceleration" }\n'
    found = diagnosed(write(tmp_path, rig, [table], columns), CANDIDATES)
    assert [each["effect"] for each in found.causes] == list(effects)


def test_a_transient_needs_a_response(tmp_path):
    time = np.arange(200.0) / 100.0
    path = write(tmp_path, OSCILLATOR, [[time, np.exp(-time) * np.cos(9.0 * time)]], "")
    with pytest.raises(MeasuredError, match="displacement: missing, and so are velocity and acceleration"):
        read(path)
    written = path.read_text().replace("[[meas", CHANNEL.format("") + "[[meas")
    path.write_text(written)
    assert read(path).tests[0].displacement is None
    path = write(tmp_path, OSCILLATOR, [[time, np.cos(31.4 * time)]], CHANNEL.format(""))
    with pytest.raises(MeasuredError, match=r"does not decay \(it swings by 2 m/s"):
        read(path)
