"""Modes of linear equations: their closed form, its first event, and the systems that have it."""

import numpy as np
import pytest
from scipy.linalg import expm

from tests.physics import compiled_mechanics as mechanics
from wedgesweep.compiled import compiled
from wedgesweep.hybrid import linear_modes
from wedgesweep.hybrid.linear_modes import SCAN, Motion
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.events import COLUMN_NORMAL

OMEGA_N = (5100 / 0.70) ** 0.5


@compiled
def moved(phase, time, motion):
    """The phase (cosine, sine, w, w') some time later."""
    return linear_modes._advanced(linear_modes.Phase(phase[0], phase[1], phase[2], phase[3]), time, motion)


@pytest.mark.parametrize(
    ("spring", "damper", "constant"),
    [
        pytest.param(-1.0, 0.0, 0.0, id="undamped"),
        pytest.param(-0.7, -0.3, 0.0, id="damped"),
        pytest.param(-0.2, -1.0, 0.0, id="overdamped"),
        pytest.param(-0.25, -1.0, 0.0, id="critical"),
        pytest.param(0.6, 0.2, 0.0, id="unstable"),
        pytest.param(0.0, 0.0, 0.8, id="free"),
        pytest.param(0.0, -0.9, 0.8, id="a damper alone"),
    ],
)
def test_a_move_is_the_exponential_of_the_equations(spring, damper, constant):
    """W'' = constant + spring w + damper w', with the longest interval and with parts of it."""
    longest = 2.0 * np.pi / SCAN
    motion, start = Motion(constant, spring, damper, 1.0, longest), (0.6, 0.8, 0.3, -0.5)
    equations = np.array([[0.0, 1.0, 0.0], [spring, damper, constant], [0.0, 0.0, 0.0]])
    for time in (longest, 0.4 * longest, 1e-9):
        c, s, w, rate = moved(start, time, motion)
        turned = (0.6 + 0.8j) * np.exp(1j * time)
        expected = expm(equations * time) @ (*start[2:], 1.0)
        np.testing.assert_allclose((c, s), (turned.real, turned.imag), rtol=0.0, atol=4e-16)
        np.testing.assert_allclose((w, rate), expected[:2], rtol=0.0, atol=4e-16)


def equations_of(on, p):
    """Coefficients of 1, x, x', cosine and sine in the acceleration and both normal forces, shape (3, 5)."""

    def at(time, x=0.0, velocity=0.0):
        now = mechanics.contact_forces(time, (x, velocity), on, p)
        return np.array([now.acceleration, now.column, now.bolster])

    quarter = np.pi / 2 / p["input"]["omega"]
    origin, half = at(0.0), at(2 * quarter)
    mean = (origin + half) / 2
    by_x, by_velocity = (at(0.0, x=1e-3) - origin) / 1e-3, at(0.0, velocity=1.0) - origin
    return np.array([mean, by_x, by_velocity, origin - mean, at(quarter) - mean]).T


def margins_of(times, t, state, on, p):
    """Slip velocity and normal forces at even times, as positive numbers while the contact holds.

    By the exponential of the equations' matrix, which knows no closed form of a motion.
    """
    omega, (acceleration, column, bolster) = p["input"]["omega"], equations_of(on, p)
    matrix = np.zeros((5, 5))  # of 1, x, x', cosine, sine
    matrix[1, 2], matrix[2] = 1.0, acceleration
    matrix[3, 4], matrix[4, 3] = -omega, omega
    now = np.array([1.0, *state, np.cos(omega * t), np.sin(omega * t)])
    path, step = [expm(matrix * (times[0] - t)) @ now], expm(matrix * (times[1] - times[0]))
    for _ in times[1:]:
        path.append(step @ path[-1])
    path = np.array(path).T
    return np.array(
        [on.column * path[2], on.column_sign * (column @ path), on.bolster_sign * (bolster @ path)]
    )


def test_the_closed_form_misses_no_event():
    """Also where a force dips below zero and returns within one scanned interval, the first one included.

    That interval may begin where the other force has vanished.
    """
    generator, dips, followed = np.random.default_rng(3), 0, 0
    for _ in range(600):
        amplitude, beta = 10 ** generator.uniform(-4, -2.3), generator.uniform(0.3, 3.0)
        lean = np.radians(generator.choice([4.0, 0.3]))
        record = parameters.record("coulomb", amplitude, beta * OMEGA_N, {"column_angle": lean})
        p, period = parameters.compact(record)[0], 2 * np.pi / record["input"]["omega"][0]
        t = generator.uniform(0.0, period)
        state = tuple(generator.normal(size=2) * amplitude * (1.0, beta * OMEGA_N))
        on, _ = mechanics.initial_mode(t, state, p)
        end, there, event = mechanics.slid(t, t + period, state, on, p)
        assert margins_of(np.linspace(t, end, 1000)[1:-1], t, state, on, p).min() > 0.0
        if event < COLUMN_NORMAL:
            continue
        dips += 1
        there, on, _ = mechanics.transition(end, there, on, event, p)
        last, _, _ = mechanics.slid(end, end + period, there, on, p)
        if last > end:
            followed += 1
            assert margins_of(np.linspace(end, last, 1000)[1:-1], end, there, on, p).min() > 0.0
    assert dips > 60
    assert followed > 50
