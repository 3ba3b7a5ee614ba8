"""The extended mechanics against Newton's equations written out as vectors, for random states."""

from itertools import product

import numpy as np
import pytest

from tests.physics.cases import OMEGA_N
from tests.physics.effect_cases import EXTENDING, residual, typical
from wedgesweep import damper, parameters
from wedgesweep.extended import rest, switching
from wedgesweep.extended.jumps import settled
from wedgesweep.extended.mechanics import Loads, loaded_reactions, reactions
from wedgesweep.extended.mode import AGE, BRISTLE, SIZE, VELOCITY
from wedgesweep.friction import LAW_NAMES
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.trajectory import Window


def record_of(law, generator, names, column_angle=0.07):
    place = generator.uniform(0.05, 0.95)
    return parameters.record(
        law,
        10 ** generator.uniform(-5, -3),
        generator.uniform(0.1, 3.0) * OMEGA_N,
        suspension={"column_angle": column_angle},
        friction={"dynamic": generator.uniform(0.0, 0.2), "static": generator.uniform(0.0, 0.2)},
        effects={name: typical(name, place) for name in names},
    )


def random_state(p, generator):
    y = np.zeros(SIZE)
    y[0] = generator.uniform(-2e-3, 2e-3)
    y[VELOCITY] = generator.choice([-1, 1]) * 10 ** generator.uniform(-4.5, 0)
    if p["presliding_length"] > 0.0:
        y[BRISTLE] = generator.uniform(-1, 1)
    if p["column_compliance_stiffness"] > 0.0:
        y[3:5] = generator.uniform(-1e-4, 1e-4), generator.uniform(-1e-2, 1e-2)
    if p["fixture_resonance_frequency"] > 0.0:
        y[5:7] = generator.uniform(-1e-4, 1e-4), generator.uniform(-1e-2, 1e-2)
    if p["ageing_rate"] > 0.0:
        y[AGE] = generator.uniform(0, 0.1)
    return y


def check(record, generator):
    p = record[0]
    t, y = generator.uniform(0, 3), random_state(p, generator)
    mode, unique = switching.initial(t, y, p)
    _, now, _ = settled(t, y, mode, p)
    scale = p["bolster_mass"] * (p["gravity"] + p["amplitude"] * p["omega"] ** 2 + abs(now.acceleration))
    scale += p["bolster_spring"] * 1e-3 + p["end_stop_stiffness"] * 1e-3
    if unique:
        assert mode.column_sign * now.column >= 0.0
        assert mode.bolster_sign * now.bolster >= 0.0
        np.testing.assert_allclose(residual(t, y, mode, p, now), 0.0, atol=1e-10 * scale)
    return unique


@pytest.mark.parametrize(("law", "name"), list(product(LAW_NAMES, EXTENDING)))
def test_forces_solve_newtons_equations_with_each_effect(law, name):
    generator = np.random.default_rng(2)
    unique = [check(record_of(law, generator, [name]), generator) for _ in range(40)]
    assert sum(unique) >= 30


@pytest.mark.parametrize("law", LAW_NAMES)
@pytest.mark.parametrize("lean", [-0.07, 0.07])
def test_forces_solve_newtons_equations_with_any_effects_together(law, lean):
    generator = np.random.default_rng(3)
    unique = []
    for _ in range(60):
        names = generator.choice(EXTENDING, 4, replace=False)
        unique.append(check(record_of(law, generator, names, lean), generator))
    assert sum(unique) >= 30


@pytest.mark.parametrize("law", LAW_NAMES)
def test_without_effects_the_extended_system_is_the_base_model(law):
    generator = np.random.default_rng(4)
    for _ in range(50):
        base = record_of(law, generator, [])
        record = base.copy()
        record["extended"] = 1.0
        rest.prepare(record[0])
        p, t, y = record[0], generator.uniform(0, 3), random_state(record[0], generator)
        mode, unique = switching.initial(t, y, p)
        slope = np.empty(SIZE)
        now = switching.rate(t, y, mode, p, slope)
        base_acceleration = -p["amplitude"] * p["omega"] ** 2 * np.sin(p["omega"] * t)
        plain = damper.Contact(*mode[:5])
        expected = damper.forces(y[0], y[VELOCITY], base_acceleration, plain, base[0])
        assert unique
        assert slope[VELOCITY] == pytest.approx(expected.acceleration, rel=1e-12)
        assert now.column == pytest.approx(expected.column, rel=1e-9)
        assert now.bolster == pytest.approx(expected.bolster, rel=1e-9)


@pytest.mark.parametrize("name", ["column_compliance", "fixture_resonance"])
@pytest.mark.parametrize("most", [0.3, 1.2])
def test_a_wedge_that_is_proved_never_to_lock_has_one_pair_of_normal_forces_in_any_state(name, most):
    generator = np.random.default_rng(5)
    locked = {0.0: [], 1.0: []}
    for place in generator.uniform(0.05, 0.95, 30):
        friction = {"dynamic": generator.uniform(0.0, most), "static": generator.uniform(0.0, most)}
        record = parameters.record(
            "static-dynamic", 1e-4, OMEGA_N, friction=friction, effects={name: typical(name, place)}
        )
        proved = float(record["never_locks"][0])
        record["never_locks"] = 0.0
        p = record[0]
        for _ in range(40):
            _, unique = switching.initial(generator.uniform(0, 3), random_state(p, generator), p)
            locked[proved].append(not unique)
    assert locked[1.0]
    assert not any(locked[1.0])
    assert most < 1.0 or any(locked[0.0])


@pytest.mark.parametrize("exponent", [-0.5, 0.1, 1 / 3, 0.6, 0.9])
def test_normal_forces_under_friction_that_depends_on_them_are_found(exponent):
    """From forces that solve the linear equations follow coefficients under which they are the answer."""
    generator = np.random.default_rng(6)
    effects = {"load_dependent_friction": {"exponent": exponent, "reference": 100.0}}
    p = parameters.record("exponential", 1e-4, OMEGA_N, effects=effects)[0]
    found = []
    while len(found) < 300:
        load = Loads(*generator.normal(size=6) * [60.0, 60.0, 200.0, 0.0, 0.0, 15.0])
        mu = generator.uniform(-0.3, 0.3, 2)
        expected, _ = reactions(load, *mu, 0.0, 0.0, p)
        forces = np.array([expected.column, expected.bolster])
        now, _ = loaded_reactions(load, *mu * (np.abs(forces) / 100.0) ** exponent, p)
        found.append(np.allclose([now.column, now.bolster], forces, rtol=1e-8))
    # Others are as good an answer: two pairs of forces, or signs under which no pair is the only one.
    assert np.mean(found) > 0.97


@pytest.mark.parametrize("name", EXTENDING)
def test_the_run_begins_where_nothing_moves_without_friction(name):
    record = parameters.record(
        "static-dynamic",
        1e-12,
        50.0,
        friction={"dynamic": 0.0, "static": 0.0},
        effects={name: typical(name) | ({"acceleration": 0.0} if name == "stray_vibration" else {})},
    )
    y, slope = np.zeros(SIZE), np.empty(SIZE)
    mode, _ = switching.initial(0.0, y, record[0])
    switching.rate(0.0, y, mode, record[0], slope)
    assert np.abs(slope[:7]).max() < 1e-8


@pytest.mark.parametrize("law", ["static-dynamic", "exponential"])
def test_a_run_begins_in_the_direction_that_the_input_drives_not_that_of_rounding(law):
    """At phase 0 forces balance; a moment later the side frame falls behind, and z grows."""
    for scale in np.linspace(0.8, 1.2, 11):
        effects = {"bolster_stiffness": {"scale": scale}, "directional_friction": {"asymmetry": -0.09}}
        record = parameters.record(law, 5e-5, 180.0, effects=effects)
        mode, unique = switching.initial(0.0, np.zeros(SIZE), record[0])
        assert unique
        assert mode.direction == 1
        window = Window(180.0, 1, 1, 16)
        assert np.isfinite(radau.solve(record, window, 1e-4, 60.0).samples.x).all()


@pytest.mark.parametrize("law", ["static-dynamic", "exponential"])
def test_a_run_begins_in_the_direction_that_the_input_drives_through_a_compliant_table(law):
    """The side frame follows the table late, and z the side frame: at phase 0 not even forces grow."""
    effects = {
        "directional_friction": {"asymmetry": 0.03},
        "fixture_resonance": {"frequency": 363.0, "damping_ratio": 0.055},
    }
    record = parameters.record(law, 2.4e-4, 131.6, effects=effects)
    mode, unique = switching.initial(0.0, np.zeros(SIZE), record[0])
    assert unique
    assert mode.direction == 1
    window = Window(131.6, 1, 1, 64)
    runs = [solve(record, window, 1e-8, 60.0).samples.x for solve in (radau.solve, event_driven.solve)]
    np.testing.assert_allclose(*runs, atol=1e-6 * np.ptp(runs[0]))


@pytest.mark.parametrize("phase", [0.5, 2.0, 4.0])
def test_a_start_to_one_side_that_soon_turns_to_the_other_is_resolved(phase):
    """A foreign tone pulls down for microseconds, until the input that begins at 0 has outgrown it."""
    effects = {
        "directional_friction": {"asymmetry": 0.01},
        "stray_vibration": {"acceleration": 1.3e-3, "frequency": 8.0, "phase": phase},
    }
    record = parameters.record("exponential", 7e-5, 207.0, effects=effects)
    window = Window(207.0, 1, 1, 64)
    runs = [solve(record, window, 1e-8, 60.0).samples.x for solve in (radau.solve, event_driven.solve)]
    np.testing.assert_allclose(*runs, atol=1e-6 * np.ptp(runs[0]))
