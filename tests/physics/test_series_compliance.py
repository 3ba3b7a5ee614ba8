"""A damper behind a spring: Maxwell's and Prandtl's elements, and both at once, in closed form."""

from math import inf, log, pi

import numpy as np
import pytest

from tests.physics.test_oscillator import AMPLITUDE, OMEGA_N, K, M, coulomb, oscillator, steady
from wedgesweep.solvers import event_driven, imposed_motion
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.oscillator import parameters

# Damping (N s/m), friction (N) and stiffness in series (N/m) of a damper whose motion is imposed.
DAMPING, FRICTION, SERIES = 2000.0, 50.0, 2e5


def damper(damping=DAMPING, friction=FRICTION, series=SERIES, **effects):
    """A damper alone, with next to no mass and no spring beside it."""
    numbers = {"mass": 1e-9, "spring": 0.0, "damping": damping, "normal_force": friction}
    effects = {"series_compliance": {"stiffness": series}, **effects}
    return parameters.record("coulomb", 0.0, 1.0, numbers, coulomb(1.0), effects)


def forces(record, displacement, velocity, acceleration, step):
    return imposed_motion.forces(record, displacement, velocity, acceleration, step)[0]


def sine(samples, amplitude, cycles=3):
    """Displacement, velocity and acceleration of cycles of 1 s."""
    angle, omega = 2.0 * pi * np.arange(samples * cycles) / samples, 2.0 * pi
    return (
        amplitude * np.sin(angle),
        amplitude * omega * np.cos(angle),
        -amplitude * omega**2 * np.sin(angle),
    )


def test_without_friction_it_is_maxwells_element():
    """The amplitude under a moving base, by the complex stiffness of spring and damper in series."""
    damping, series, omega = 40.0, 3.0 * K, 0.8 * OMEGA_N
    effects = {"series_compliance": {"stiffness": series, "coefficient": 15.0}}
    record = parameters.record(
        "coulomb", AMPLITUDE, omega, oscillator(damping=damping - 15.0), coulomb(0.0), effects
    )
    impedance = 1.0 / (1.0 / series + 1.0 / (1j * omega * damping))
    expected = abs(M * omega**2 / (K + impedance - M * omega**2))
    assert steady(record, rtol=1e-9, settle=30).numbers["amplitude_ratio"] == pytest.approx(
        expected, rel=1e-6
    )


@pytest.mark.parametrize("direction", [-1.0, 1.0])
def test_friction_holds_the_damper_and_not_the_mass(direction):
    """A mass let go swings about the end of its spring; it never rests where friction would have held it."""
    effects = {"series_compliance": {"stiffness": K, "coefficient": 1.0}}
    record = parameters.record("coulomb", 1e-12, OMEGA_N, oscillator(), coulomb(0.5), effects, "force")
    start = direction * 0.5 * 0.5 / K
    omega = np.sqrt(2.0 * K / M)
    run = event_driven.solve(record, Window(OMEGA_N, 0, 1, 256), 1e-10, inf, start=(start, 0.0))
    found = run.samples
    # Both springs act, and the one in series is free at the start.
    expected = 0.5 * start * (1.0 + np.cos(omega * (found.t - found.t[0])))
    assert -found.x == pytest.approx(expected, abs=1e-7 * abs(start))
    assert found.sticks.all()
    # A spring takes no energy, in any part of a swing.
    assert abs(run.sums["dissipated"][0]) < 1e-9 * K * start**2


@pytest.mark.parametrize("samples", [200, 5000])
def test_without_damping_it_is_prandtls_element(samples):
    """The loop is a parallelogram, shorter than the travel by what the spring yields at both ends."""
    amplitude = 0.01
    force = forces(damper(damping=0.0), *sine(samples, amplitude), 1.0 / samples)
    _, velocity, _ = sine(samples, amplitude)
    later = slice(samples, 2 * samples)
    assert np.abs(force).max() == pytest.approx(FRICTION, rel=1e-9)
    area = (force * velocity)[later].sum() / samples
    assert area == pytest.approx(4.0 * FRICTION * (amplitude - FRICTION / SERIES), rel=2.0 / samples)


@pytest.mark.parametrize("asymmetry", [0.0, 0.4])
def test_a_reversal_runs_through_relaxation_rest_and_relaxation(asymmetry):
    """At a constant speed that turns: an exponential to where friction holds, a line, an exponential."""
    speed, samples, step = 0.1, 4000, 1e-5
    effects = {"directional_damping": {"asymmetry": asymmetry}} if asymmetry else {}
    velocity = speed * np.where(np.arange(samples) < samples // 4, 1.0, -1.0)
    force = forces(damper(**effects), np.cumsum(velocity) * step, velocity, 0.0 * velocity, step)
    time = (np.arange(samples) - samples // 4 + 0.5) * step
    up, down = (1.0 + asymmetry) * DAMPING, (1.0 - asymmetry) * DAMPING
    stops = up / SERIES * log(2.0)
    reverses = stops + 2.0 * FRICTION / (SERIES * speed)
    expected = np.select(
        [time < 0.0, time < stops, time < reverses],
        [
            FRICTION + up * speed,
            FRICTION + up * speed * (2.0 * np.exp(-SERIES * time / up) - 1.0),
            FRICTION - SERIES * speed * (time - stops),
        ],
        -FRICTION - down * speed * (1.0 - np.exp(-SERIES * (time - reverses) / down)),
    )
    assert force == pytest.approx(expected, abs=1.1 * SERIES * speed * step)


@pytest.mark.parametrize("samples", [100, 1600])
def test_drag_behind_the_spring_unloads_it_as_a_tank_empties(samples):
    """At rest e' = -sqrt(k e/q): the root of the force falls evenly, and at a constant speed it stays."""
    drag, speed, duration = 1e4, 0.2, 8e-3
    step = duration / samples
    velocity = np.append([speed], np.zeros(samples - 1))
    record = damper(0.0, 0.0, quadratic_drag={"coefficient": drag})
    force = forces(record, 0.0 * velocity, velocity, 0.0 * velocity, step)
    assert force[0] == pytest.approx(drag * speed**2, rel=1e-12)
    time = step * np.arange(samples - 1)
    root = np.sqrt(force[1]) - 0.5 * SERIES / np.sqrt(drag) * time
    assert root.min() > 0.0
    assert np.sqrt(force[1:]) == pytest.approx(root, rel=200.0 / samples**2)


def test_a_stiff_spring_is_none():
    x, v, a = sine(500, 0.01)
    assert forces(damper(series=1e12), x, v, a, 2e-3) == pytest.approx(
        DAMPING * v + FRICTION * np.sign(v), abs=0.02 * FRICTION, rel=1e-6
    )
