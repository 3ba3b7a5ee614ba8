"""The mechanics against Newton's equations written out as vectors, for random states."""

from itertools import product
from math import cos, sin

import numpy as np
import pytest

from tests.physics.cases import OMEGA_N
from wedgesweep import contact, damper, excitation, friction, parameters
from wedgesweep.damper import Contact
from wedgesweep.friction import LAW_NAMES
from wedgesweep.solvers.pieces import jacobian, rate

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
        yield record, generator.uniform(0, 10), generator.uniform(-5e-3, 5e-3), velocity


def coefficients(velocity, p, now):
    return (
        friction.coefficient(p["column_ratio"] * velocity, now.column, p),
        friction.coefficient(p["bolster_ratio"] * velocity, now.bolster, p),
    )


def newton_residual(t, x, velocity, now, p, result):
    """Left minus right of PHYSICS.md's equations: two components for the wedge, one for the bolster."""
    a, g = p["wedge_angle"], p["column_angle"]
    along_column, into_column = np.array([-sin(g), cos(g)]), np.array([cos(g), sin(g)])
    along_bolster, into_wedge = np.array([sin(a), cos(a)]), np.array([cos(a), -sin(a)])
    up = np.array([0.0, 1.0])
    column_mu, bolster_mu = coefficients(velocity, p, now)
    z, base = p["rest"] + x, excitation.acceleration(t, p)
    r = sin(a) / sin(a + g)
    spring = p["wedge_preload"] - p["wedge_spring"] * r * z * cos(g)
    on_column = result.column * into_column + column_mu * abs(result.column) * along_column
    on_bolster = result.bolster * into_wedge - bolster_mu * abs(result.bolster) * along_bolster
    wedge = (
        p["wedge_mass"] * (base * up + r * result.acceleration * along_column)
        - (spring - p["wedge_mass"] * p["gravity"]) * up
        + on_column
        - on_bolster
    )
    threshold = p["threshold_velocity"]
    guide = p["guide_friction_force"] * (now.guide if now.guide or p["set_valued"] else velocity / threshold)
    bolster = (
        p["bolster_mass"] * (base + result.acceleration)
        + p["bolster_spring"] * z
        + p["bolster_mass"] * p["gravity"]
        + 2 * on_bolster @ up
        + guide
    )
    return np.array([*wedge, bolster])


@pytest.mark.parametrize(("law", "lean"), list(product(LAW_NAMES, LEANS)))
def test_forces_solve_newtons_equations_with_exactly_one_pair_of_signs(law, lean):
    for record, t, x, velocity in random_states(law, lean, 450):
        p = record[0]
        now, unique = contact.initial(t, x, velocity, p)
        result = damper.forces(x, velocity, excitation.acceleration(t, p), now, p)
        assert unique
        assert now.column_sign * result.column >= 0.0
        assert now.bolster_sign * result.bolster >= 0.0
        scale = p["bolster_mass"] * (p["gravity"] + abs(excitation.acceleration(t, p)))
        scale += p["bolster_spring"] * abs(x)
        np.testing.assert_allclose(newton_residual(t, x, velocity, now, p, result), 0.0, atol=1e-11 * scale)


@pytest.mark.parametrize("law", LAW_NAMES)
def test_jacobian_is_the_derivative_of_the_rate(law):
    for record, t, x, velocity in random_states(law, 0.07, 100):
        now, _ = contact.initial(t, x, velocity, record[0])
        exact = jacobian(t, np.array([x, velocity]), now, record)
        for column, step in enumerate((1e-6, 1e-6 * abs(velocity))):
            shift = np.zeros(2)
            shift[column] = step
            ahead = rate(t, np.array([x, velocity]) + shift, now, record)
            behind = rate(t, np.array([x, velocity]) - shift, now, record)
            np.testing.assert_allclose(exact[:, column], (ahead - behind) / (2 * step), rtol=1e-5, atol=1e-3)


@pytest.mark.parametrize("law", LAW_NAMES)
def test_laws_are_odd_bounded_and_passive(law):
    p = parameters.record(law, 1e-3, 1.0)[0]
    for velocity in np.logspace(-6, 1, 60):
        branch = friction.branch_at(velocity, p)
        value = friction.coefficient(velocity, branch, p)
        assert value == -friction.coefficient(-velocity, -branch, p)
        assert 0.0 < value <= max(p["static"], p["dynamic"])


def test_laws_jump_from_static_to_dynamic_at_the_threshold():
    for law in ("static-dynamic", "exponential"):
        p = parameters.record(law, 1e-3, 1.0)[0]
        threshold = p["threshold_velocity"]
        assert friction.coefficient(threshold, 0, p) == pytest.approx(p["static"])
        assert friction.coefficient(threshold, 1, p) == pytest.approx(p["dynamic"])


def test_a_steep_wedge_with_much_friction_locks():
    record = parameters.record(
        "coulomb",
        1e-3,
        0.4 * OMEGA_N,
        suspension={"column_angle": -0.06981317007977318},
        friction={"dynamic": 0.5},
    )
    assert not contact.initial(0.0, 0.0, 0.0, record[0])[1]


def test_guide_friction_of_zero_changes_no_bit():
    base = parameters.record("static-dynamic", 1e-3, 30.0)
    off = parameters.record("static-dynamic", 1e-3, 30.0, effects={"guide_friction": {"force": 0.0}})
    state, now = np.array([1e-4, 5e-3]), Contact(1, 0, 1, 1, 1)
    np.testing.assert_array_equal(rate(0.3, state, now, base), rate(0.3, state, now, off))
