"""The mechanics against Newton's equations written out as vectors, for random states."""

from itertools import product
from math import inf

import numpy as np
import pytest

from tests.physics import compiled_mechanics as mechanics
from tests.physics.cases import OMEGA_N
from tests.physics.compiled_mechanics import with_all_mechanics
from tests.physics.effect_cases import EXTENDING, residual, typical
from wedgesweep.friction import LAW_NAMES
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.newton import Coefficients, Loads

LEANS = (-0.07, 0.0, 0.07)


def random_states(law, column_angle, number, seed=1):
    """Records, times and states spread over slip velocities below and far above the threshold."""
    generator = np.random.default_rng(seed)
    for _ in range(number):
        amplitude = 10 ** generator.uniform(-5, -2.3)
        record = parameters.record(
            law,
            amplitude,
            generator.uniform(0.1, 3.0) * OMEGA_N,
            suspension={"column_angle": column_angle},
            friction={"dynamic": generator.uniform(0, 0.32), "static": generator.uniform(0, 0.32)},
            effects={"guide_friction": {"force": generator.uniform(0, 1)}},
        )
        velocity = generator.choice([-1, 1]) * 10 ** generator.uniform(-4.5, 0)
        yield record, generator.uniform(0, 10), (generator.uniform(-5e-3, 5e-3), velocity)


def record_of(law, generator, names, column_angle=0.07, **suspension):
    place = generator.uniform(0.05, 0.95)
    return parameters.record(
        law,
        10 ** generator.uniform(-5, -3),
        generator.uniform(0.1, 3.0) * OMEGA_N,
        suspension={"column_angle": column_angle, **suspension},
        friction={"dynamic": generator.uniform(0.0, 0.2), "static": generator.uniform(0.0, 0.2)},
        effects={name: typical(name, place) for name in names},
    )


def random_state(p, generator):
    """State of a full record."""
    values = {("", 0): generator.uniform(-2e-3, 2e-3)}
    values["", 1] = generator.choice([-1, 1]) * 10 ** generator.uniform(-4.5, 0)
    if p["presliding"]["length"] > 0.0:
        values["presliding", 0] = generator.uniform(-1, 1)
    for name, quantity in (("column_compliance", "stiffness"), ("fixture_resonance", "frequency")):
        if p[name][quantity] > 0.0:
            values[name, 0], values[name, 1] = generator.uniform(-1e-4, 1e-4), generator.uniform(-1e-2, 1e-2)
    if p["ageing"]["rate"] > 0.0:
        values["ageing", 0] = generator.uniform(0, 0.1)
    return mechanics.initial_state(p, values)


def begun(record):
    """Mode at the start of a run from rest, and whether it is unique."""
    p = parameters.compact(record)[0]
    return mechanics.initial_mode(0.0, mechanics.initial_state(p), p)


def input_acceleration(p):
    return p["input"]["amplitude"] * p["input"]["omega"] ** 2


def check(record, generator):
    p = with_all_mechanics(record)[0]
    t, y = generator.uniform(0, 3), random_state(p, generator)
    mode, unique = mechanics.initial_mode(t, y, p)
    _, now, _ = mechanics.resolve_mode(t, y, mode, p)
    s = p["suspension"]
    scale = s["bolster_mass"] * (s["gravity"] + input_acceleration(p) + abs(now.acceleration))
    scale += s["bolster_spring"] * 1e-3 + p["end_stop"]["stiffness"] * 1e-3
    if unique:
        assert mode.column_sign * now.column >= 0.0
        assert mode.bolster_sign * now.bolster >= 0.0
        np.testing.assert_allclose(residual(t, y, mode, p, now), 0.0, atol=1e-10 * scale)
    return unique


@pytest.mark.few(3)
@pytest.mark.parametrize(("law", "lean"), list(product(LAW_NAMES, LEANS)))
def test_forces_solve_newtons_equations_with_exactly_one_pair_of_signs(law, lean):
    for record, t, y in random_states(law, lean, 150):
        p, small = with_all_mechanics(record)[0], parameters.compact(record)[0]
        s = p["suspension"]
        mode, unique = mechanics.initial_mode(t, y, small)
        now = mechanics.contact_forces(t, y, mode, small)
        assert unique
        assert mode.column_sign * now.column >= 0.0
        assert mode.bolster_sign * now.bolster >= 0.0
        base = input_acceleration(p) * abs(np.sin(p["input"]["omega"] * t))
        scale = s["bolster_mass"] * (s["gravity"] + base) + s["bolster_spring"] * abs(y[0])
        full = mechanics.initial_state(p, {("", 0): y[0], ("", 1): y[1]})
        np.testing.assert_allclose(residual(t, full, mode, p, now), 0.0, atol=1e-11 * scale)


@pytest.mark.few(len(EXTENDING))
@pytest.mark.parametrize(("name", "law"), list(product(EXTENDING, LAW_NAMES)))
def test_forces_solve_newtons_equations_with_each_effect(law, name):
    generator = np.random.default_rng(2)
    unique = [check(record_of(law, generator, [name]), generator) for _ in range(40)]
    assert sum(unique) >= 30


@pytest.mark.few(2)
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
def test_laws_are_odd_bounded_and_passive(law):
    record = parameters.record(law, 1e-3, 1.0)
    p, y = parameters.compact(record)[0], (0.0, 0.0)
    for velocity in np.logspace(-6, 1, 60):
        branch = 1 if p["friction"]["set_valued"] else mechanics.branch_at(velocity, p)
        value = mechanics.coefficient(velocity, branch, y, p)
        assert value == -mechanics.coefficient(-velocity, -branch, y, p)
        assert 0.0 < value <= max(p["friction"]["mu_s"], p["friction"]["mu_d"])
    if not p["friction"]["set_valued"]:  # they jump from static to dynamic at the threshold
        threshold = p["friction"]["v_t"]
        assert mechanics.coefficient(threshold, 0, y, p) == pytest.approx(p["friction"]["mu_s"])
        assert mechanics.coefficient(threshold, 1, y, p) == pytest.approx(p["friction"]["mu_d"])


@pytest.mark.parametrize("name", ["column_compliance", "fixture_resonance"])
@pytest.mark.parametrize("most", [0.3, 1.2])
def test_a_wedge_that_is_proved_never_to_lock_has_one_pair_of_normal_forces_in_any_state(name, most):
    generator = np.random.default_rng(5)
    locked = {0: [], 1: []}
    for place in generator.uniform(0.05, 0.95, 30):
        friction = {"dynamic": generator.uniform(0.0, most), "static": generator.uniform(0.0, most)}
        record = parameters.record(
            "static-dynamic", 1e-4, OMEGA_N, friction=friction, effects={name: typical(name, place)}
        )
        proved = int(record["geometry"]["always_well_posed"][0])
        record["geometry"]["always_well_posed"] = 0
        p = with_all_mechanics(record)[0]
        for _ in range(40):
            _, unique = mechanics.initial_mode(generator.uniform(0, 3), random_state(p, generator), p)
            locked[proved].append(not unique)
    assert locked[1]
    assert not any(locked[1])
    assert most < 1.0 or any(locked[0])


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
        expected, _ = mechanics.reactions(load, Coefficients(*mu, 0.0, 0.0), p)
        forces = np.array([expected.column, expected.bolster])
        now, _ = mechanics.loaded_reactions(load, *mu * (np.abs(forces) / 100.0) ** exponent, p)
        found.append(np.allclose([now.column, now.bolster], forces, rtol=1e-8))
    # Others are as good an answer: two pairs of forces, or signs under which no pair is the only one.
    assert np.mean(found) > 0.97


@pytest.mark.parametrize("name", EXTENDING)
def test_the_run_begins_where_nothing_moves_without_friction(name):
    p = parameters.record(
        "static-dynamic",
        1e-12,
        50.0,
        friction={"dynamic": 0.0, "static": 0.0},
        effects={name: typical(name) | ({"acceleration": 0.0} if name == "stray_vibration" else {})},
    )
    p = with_all_mechanics(p)[0]
    y = mechanics.initial_state(p)
    mode, _ = mechanics.initial_mode(0.0, y, p)
    slope = mechanics.owned(mechanics.rate(0.0, y, mode, p)[0], p)
    slope.pop("ageing")  # time
    assert np.abs(np.concatenate(list(slope.values()))).max() < 1e-8


@pytest.mark.parametrize("law", ["static-dynamic", "exponential"])
def test_a_run_begins_in_the_direction_that_the_input_drives_not_that_of_rounding(law):
    """At phase 0 forces balance; a moment later the side frame falls behind, and z grows.

    On a compliant table the side frame follows late, and at phase 0 not even forces grow.
    """
    table = {"fixture_resonance": {"frequency": 363.0, "damping_ratio": 0.055}}
    scaled = [{"bolster_stiffness": {"scale": scale}} for scale in np.linspace(0.8, 1.2, 11)]
    for effects, amplitude, omega in (*((each, 5e-5, 180.0) for each in scaled), (table, 2.4e-4, 131.6)):
        effects["directional_friction"] = {"asymmetry": -0.09 if effects in scaled else 0.03}
        mode, unique = begun(parameters.record(law, amplitude, omega, effects=effects))
        assert unique
        assert mode.direction == 1


# On a compliant table; and a spurious tone that pulls down for microseconds, until the input outgrows it.
STARTS = [
    (2.4e-4, 131.6, 0.03, {"fixture_resonance": {"frequency": 363.0, "damping_ratio": 0.055}}),
    (7e-5, 207.0, 0.01, {"stray_vibration": {"acceleration": 1.3e-3, "frequency": 8.0, "phase": 2.0}}),
]


@pytest.mark.acceptance
@pytest.mark.parametrize(("amplitude", "omega", "asymmetry", "effects"), STARTS)
def test_both_solvers_begin_in_the_same_direction(amplitude, omega, asymmetry, effects):
    effects = effects | {"directional_friction": {"asymmetry": asymmetry}}
    record = parameters.record("exponential", amplitude, omega, effects=effects)
    window = Window(omega, 1, 1, 64)
    runs = [solve(record, window, 1e-8, inf).samples.x for solve in (radau.solve, event_driven.solve)]
    np.testing.assert_allclose(*runs, atol=1e-6 * np.ptp(runs[0]))
