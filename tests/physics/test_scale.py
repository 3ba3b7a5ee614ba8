"""A rig of another size moves in proportion, under every effect."""

from functools import cache
from math import inf, pi

import numpy as np
import pytest

from tests.physics.effect_cases import OF_SUSPENSION, mild
from tests.scaling import BENCH_SIZE, POWERS_OF_TWO, SIZES
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.suspension import parameters

HERTZ, AMPLITUDE = 20.0, 0.1e-3
EXPLICIT = [(name, "static-dynamic") for name in OF_SUSPENSION] + [("cross_slip", "coulomb")]
# Rounding of implicit steps depends on the order of pivots, and that on the units.
CASES = [*EXPLICIT, ("column_compliance", "coulomb")]


@cache
def bench(law, name, solver):
    """The motion of the bench, to which those of all sizes are compared."""
    return motion(BENCH_SIZE, law, {name: mild(name)}, solver)


def motion(size, law, effects, solver):
    """Displacement over length and velocity over velocity, and normal forces over weight, all (n,)."""
    omega = 2.0 * pi * HERTZ / size.time
    record = parameters.record(
        law, AMPLITUDE * size.length, omega, size.suspension(), size.friction(), size.effects(effects)
    )
    window = Window(omega, 1, 2, 64)
    run = solver.solve(record, window, rtol=1e-9, time_limit=inf).samples
    length, time = size.length, size.time
    return run.x / length, run.velocity / length * time, run.normal / size.mass / length * time**2


def in_proportion(size, law, name, tolerance, solver=event_driven):
    expected, found = bench(law, name, solver), motion(size, law, {name: mild(name)}, solver)
    return [np.abs(b - a).max() <= tolerance * np.abs(a).max() for a, b in zip(expected, found, strict=True)]


@pytest.mark.parametrize("size", SIZES.values(), ids=SIZES)
@pytest.mark.parametrize(("name", "law"), CASES)
def test_motion_is_in_proportion(name, law, size):
    displacement, velocity, forces = in_proportion(size, law, name, 1e-9)
    assert displacement
    assert velocity
    # On a steep ramp rounding of the velocity is multiplied.
    assert forces or law == "coulomb"


@pytest.mark.parametrize("size", POWERS_OF_TWO.values(), ids=POWERS_OF_TWO)
@pytest.mark.parametrize(("name", "law"), EXPLICIT)
def test_motion_is_the_same_to_the_last_bits_where_factors_round_nothing(name, law, size):
    """Nothing in the mechanics or the solver is in units of its own."""
    assert all(in_proportion(size, law, name, 1e-13))


@pytest.mark.acceptance
@pytest.mark.parametrize(
    ("name", "law", "size"),
    [
        ("velocity_lag", "coulomb", "froude"),
        ("velocity_lag", "exponential", "heavier"),
        ("fixture_resonance", "static-dynamic", "froude"),
        ("ageing", "coulomb", "heavier"),
    ],
)
def test_the_reference_solver_has_no_units_of_its_own(name, law, size):
    assert all(in_proportion(POWERS_OF_TWO[size], law, name, 1e-9, radau))


@pytest.mark.parametrize("name", ["preload", "cubic_stiffness", "column_compliance", "velocity_lag"])
@pytest.mark.parametrize("lean", [4.0, -4.0])
def test_load_dependent_friction_is_nominal_at_the_column_face_s_force_at_rest(name, lean):
    still, omega = 1e-12, 2.0 * pi * HERTZ
    suspension = {"column_angle": np.radians(lean)}
    nothing = {"dynamic": 0.0, "static": 0.0}
    record = parameters.record("static-dynamic", still, omega, suspension, nothing, {name: mild(name)})
    normal = event_driven.solve(record, Window(omega, 0, 1, 16), rtol=1e-9, time_limit=inf).samples.normal
    assert record["load_dependent_friction"]["reference"][0] == pytest.approx(normal[0, 0], rel=1e-6)
