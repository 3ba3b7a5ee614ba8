"""The force that no name explains: its table, and what a diagnosis makes of forces that are no candidates."""

import json

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from tests.command import invoke
from tests.diagnose.rigs import FORCE, FORCED, HEAD, LOOP, PLACE, oscillator, saved
from wedgesweep import api, config
from wedgesweep.config import ConfigError, force_table
from wedgesweep.effects import empirical_force as table
from wedgesweep.measured import read

PLAIN = oscillator(
    friction=1.0,
    sweep=FORCED,
    mass_kg=2.0,
    spring_N_per_mm=5.0,
    damping_N_s_per_m=50.0,
    normal_force_N=10.0,
    contact="ground",
)
CANDIDATES = ["friction_level", "cubic_stiffness"]


def forces_at(forces, place, speed):
    return table.interpolation(np.atleast_1d(place), np.atleast_1d(speed)) @ forces.ravel()


def test_forces_between_nodes_are_those_of_scipys_splines():
    forces = np.random.default_rng(0).standard_normal((table.PLACES, table.SPEEDS))
    places, speeds = table.nodes(1.0, 1.0)
    z, v = np.meshgrid(np.r_[places, 0.123, -0.97], np.r_[speeds, 0.456, -0.98], indexing="ij")
    over_place = make_interp_spline(places, forces)(z[:, 0])
    expected = make_interp_spline(speeds, over_place, axis=1)(v[0], extrapolate=False)
    assert forces_at(forces, z.ravel(), v.ravel()) == pytest.approx(expected.ravel(), abs=1e-12)
    assert forces_at(forces, 2.0, 0.0) == forces_at(forces, 1.0, 0.0)


def test_polynomials_up_to_the_third_power_are_exact():
    z, v = np.meshgrid(*table.nodes(1.0, 1.0), indexing="ij")
    place, speed = np.random.default_rng(0).uniform(-1.0, 1.0, (2, 500))

    def force(z, v):
        return 1.0 - z + 0.5 * z**3 + (2.0 + z**2) * v - 0.7 * z * v**3

    assert forces_at(force(z, v), place, speed) == pytest.approx(force(place, speed), abs=1e-12)


def test_table_of_a_config_is_read_and_read_back(tmp_path):
    forces = np.random.default_rng(0).standard_normal((table.PLACES, table.SPEEDS))
    (tmp_path / "force.csv").write_text(force_table.written(2.0, 60.0, 0.5, forces))
    text = PLAIN + '[effects.empirical_force]\ntable = "force.csv"\n'
    (tmp_path / "model.toml").write_text(text)
    found = config.load(tmp_path / "model.toml")
    own = found.effects["empirical_force"]
    assert [own[key] for key in ("displacement", "velocity", "centre")] == pytest.approx([2e-3, 0.06, 5e-4])
    assert own["coefficients"] == pytest.approx(table.coefficients(forces), abs=1e-6)
    assert config.parse(found.to_toml()).document == found.document


@pytest.mark.parametrize(
    ("line", "changed", "told"),
    [
        (5, "-2,-1,0.5", "force.csv:6: velocity_mm_per_s: -1 is no node"),
        (5, None, "230 rows; it must be 231"),
    ],
)
def test_fault_of_a_table_is_told_with_its_line(tmp_path, line, changed, told):
    lines = force_table.written(2.0, 60.0, 0.0, np.zeros((table.PLACES, table.SPEEDS))).splitlines()
    lines[line : line + 1] = [changed] if changed else []
    (tmp_path / "force.csv").write_text("\n".join(lines) + "\n")
    text = PLAIN + '[effects.empirical_force]\ntable = "force.csv"\n'
    (tmp_path / "model.toml").write_text(text)
    with pytest.raises(ConfigError, match=told):
        config.load(tmp_path / "model.toml")


def hidden_in_loops(folder, hidden):
    """Five loops of a mass on a spring that rubs, with a further force (SI)."""
    rng, tests = np.random.default_rng(7), {}
    for frequency, amplitude in ((1.0, 0.02), (2.0, 0.01), (0.5, 0.015), (1.5, 0.018), (0.7, 0.008)):
        t = np.arange(round(2000.0 / frequency)) / 250.0
        tones = ((1.0, 2.0 * np.pi * frequency, 0.0), (0.3, 0.74 * np.pi * frequency, 1.0))
        x, v, a = (
            sum(amplitude * size * w**k * np.sin(w * t + phase + 0.5 * np.pi * k) for size, w, phase in tones)
            for k in range(3)
        )
        force = 2.0 * a + 5000.0 * x + 50.0 * v + 10.0 * np.sign(v) + hidden(x, v)
        force += 5e-3 * force.std() * rng.standard_normal(t.size)
        seen = 1e3 * x + 3e-4 * rng.standard_normal(t.size)
        tests[frequency] = (t, seen, force), LOOP
    return read(saved(folder, PLAIN, HEAD + PLACE + FORCE, "t,x,F", tests))


def bump(x, v):
    """Friction that is larger about one velocity."""
    return 8.0 * np.sign(v) * np.exp(-(((np.abs(v) - 0.06) / 0.02) ** 2))


@pytest.mark.acceptance
def test_force_without_a_name_is_drawn_and_runs(tmp_path):
    measurement = hidden_in_loops(tmp_path, bump)
    found = api.diagnose_measurement(measurement, effects=CANDIDATES, n_jobs=1)
    force = found.document["empirical_force"]
    assert found.verdict == "none-of-mine"
    assert found.causes == []
    assert force["offered"]
    assert force["accuracy_held_out"] < 0.5 * force["named"]["accuracy_held_out"]
    data = found.data
    dense = data["missing_force_density"].values >= 0.5
    speeds, places = data["force_speed"].values, data["force_place"].values
    truth = -np.broadcast_to(bump(places[:, None], speeds), dense.shape)
    error = data["missing_force"].values - truth
    error -= error[dense].mean()
    assert np.sqrt((error[dense] ** 2).mean()) < 0.05 * truth[dense].std()
    found.write(tmp_path / "result")
    assert "[effects.empirical_force]" in (tmp_path / "result" / "empirical.toml").read_text()
    assert "valid" in invoke("check", tmp_path / "result" / "empirical.toml")


@pytest.mark.acceptance
def test_nothing_is_drawn_where_a_name_explains_the_tests(tmp_path):
    measurement = hidden_in_loops(tmp_path, lambda x, v: 3e6 * x**3)
    asked = [*CANDIDATES, "empirical_force"]
    found = api.diagnose_measurement(measurement, effects=asked, n_jobs=1)
    assert json.loads(found.to_json())["empirical_force"]["offered"] is False
    assert "missing_force" not in found.data
