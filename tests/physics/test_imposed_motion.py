"""The force along an imposed motion, against closed forms and against motions that a known force made."""

from math import inf

import numpy as np
import pytest

from wedgesweep.solvers import event_driven, imposed_motion
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems import moving_mass
from wedgesweep.systems.oscillator import parameters as oscillator
from wedgesweep.systems.suspension import parameters as suspension
from wedgesweep.systems.suspension.equilibrium import resonance

OSCILLATOR = {"mass": 2.0, "spring": 500.0, "damping": 3.0, "normal_force": 10.0}
FRICTION = {"dynamic": 0.3, "static": 0.3}
STEP = 1e-3


def sine(amplitude, omega, samples=4000, step=STEP, phase=0.1):
    angle = omega * step * np.arange(samples) + phase
    return amplitude * np.sin(angle), amplitude * omega * np.cos(angle), -amplitude * omega**2 * np.sin(angle)


def away_from_turns(velocity):
    """Samples whose neighbours move the same way."""
    same = velocity[:-1] * velocity[1:] > 0.0
    return np.r_[False, same] & np.r_[same, False]


def test_the_force_on_an_oscillator_is_its_inertia_spring_damper_and_friction():
    x, v, a = sine(0.01, 8.0)
    record = oscillator.record("coulomb", 0.0, 10.0, OSCILLATOR, FRICTION)
    force = imposed_motion.forces(record, x, v, a, STEP)[0]
    expected = 2.0 * a + 3.0 * v + 500.0 * x + 3.0 * np.sign(v)
    inside = away_from_turns(v)
    assert force[inside] == pytest.approx(expected[inside], abs=1e-12)


def test_a_jump_at_a_turn_counts_for_its_share_of_the_interval():
    # The mean force over a turn depends on when it happens, not on which sample comes next.
    record = oscillator.record(
        "coulomb", 0.0, 10.0, {"mass": 1e-9, "spring": 0.0, "normal_force": 10.0}, FRICTION
    )
    for late in (0.1, 0.4, 0.6, 0.9):
        v = 0.01 * (late - np.arange(-5.0, 6.0))
        force = imposed_motion.forces(record, np.zeros(11), v, np.zeros(11), STEP)[0]
        turn = 5.0 + late
        expected = 3.0 * ((turn + 0.5) - (10.5 - turn))  # integral over all cells, in samples
        assert force.sum() == pytest.approx(expected, abs=1e-9)


def coarse_and_mean(record, fine, coarse=6e-3, samples=400):
    """Displacements and forces at coarse samples, and the means over these of forces at fine ones."""
    step = coarse / fine
    every = np.array(sine(5.5e-3, 12.2, samples * fine, step))
    mean = imposed_motion.forces(record, *every, step)[0].reshape(samples, fine).mean(axis=1)
    middle = sine(5.5e-3, 12.2, samples, coarse, phase=0.1 + 12.2 * 0.5 * (coarse - step))
    return middle[0], imposed_motion.forces(record, *middle, coarse)[0], mean


@pytest.mark.parametrize("law", ["static-dynamic", "exponential"])
def test_friction_that_runs_through_its_ramp_within_a_sample_counts_by_its_mean(law):
    friction = {"dynamic": 0.3, "static": 0.36, "threshold_velocity": 2e-3}
    record = oscillator.record(law, 0.0, 10.0, {**OSCILLATOR, "damping": 0.0}, friction)
    # A turn lasts for about a sample: the velocity changes by 5 mm/s in it.
    _, force, mean = coarse_and_mean(record, 64)
    assert force == pytest.approx(mean, abs=0.02 * 3.6)


def test_bristles_follow_a_constant_velocity_as_their_closed_form():
    # Dahl: db/dx = (1 - b)/length while x grows.
    length, speed = 1e-3, 0.02
    t = STEP * np.arange(300)
    record = oscillator.record("coulomb", 0.0, 10.0, OSCILLATOR, FRICTION, {"presliding": {"length": length}})
    motion = speed * t, np.full(t.size, speed), np.zeros(t.size)
    force = imposed_motion.forces(record, *motion, STEP)[0]
    friction = force - 500.0 * motion[0] - 3.0 * speed
    assert friction == pytest.approx(3.0 * -np.expm1(-motion[0] / length), abs=1e-9)


@pytest.mark.parametrize("length", [2e-6, 2e-5, 2e-4, 2e-3])
def test_bristles_that_turn_over_within_samples_count_by_their_mean(length):
    # Around a turn the mass moves by 2e-5 m in a sample.
    record = oscillator.record("coulomb", 0.0, 10.0, OSCILLATOR, FRICTION, {"presliding": {"length": length}})
    x, force, mean = coarse_and_mean(record, 256)
    # Bristles start half a sample late.
    begun = np.maximum.accumulate(np.abs(x - x[0]) > 10.0 * length)
    assert force[begun] == pytest.approx(mean[begun], abs=0.01 * 3.0)


def test_stiff_bristles_do_not_overflow():
    x, v, a = sine(0.01, 8.0)
    stiff = oscillator.record("coulomb", 0.0, 10.0, OSCILLATOR, FRICTION, {"presliding": {"length": 1e-9}})
    plain = oscillator.record("coulomb", 0.0, 10.0, OSCILLATOR, FRICTION)
    inside = away_from_turns(v)
    forces = (imposed_motion.forces(each, x, v, a, STEP)[0][inside] for each in (stiff, plain))
    assert next(forces) == pytest.approx(next(forces), abs=1e-4)


def test_the_motion_that_a_force_made_takes_that_force():
    omega, amplitude, samples = 12.0, 20.0, 4096
    record = oscillator.record("coulomb", amplitude, omega, OSCILLATOR, FRICTION, input_kind=oscillator.FORCE)
    window = Window(omega, 40, 1, samples)
    found = event_driven.solve(record, window, 1e-10, inf).samples
    # The solver records the deflection, which is minus the displacement.
    x, v = -found.x, -found.velocity
    step = 2.0 * np.pi / omega / samples
    a = (np.roll(v, -1) - np.roll(v, 1)) / (2.0 * step)
    silent = record.copy()
    silent["input"]["amplitude"] = 0.0
    force = imposed_motion.forces(silent, x, v, a, step)[0]
    inside = away_from_turns(v) & (np.abs(v) > 1e-3)
    expected = amplitude * np.sin(omega * step * np.arange(samples))
    assert force[inside] == pytest.approx(expected[inside], abs=1e-3 * amplitude)


def test_without_friction_a_suspension_is_a_mass_on_a_spring():
    x, v, a = sine(2e-4, 20.0)
    record = suspension.record("coulomb", 0.0, 10.0, friction={"dynamic": 0.0, "static": 0.0})
    force = imposed_motion.forces(record, x, v, a, STEP)[0]
    expected = float(moving_mass(record)[0]) * (a + resonance(record[0]) ** 2 * x)
    inside = away_from_turns(v)
    assert force[inside] == pytest.approx(expected[inside], abs=1e-12)


def test_friction_of_a_suspension_takes_energy_in_every_cycle():
    x, v, a = sine(2e-4, 2.0 * np.pi, samples=1000)
    work = []
    for mu in (0.0, 0.2, 0.4):
        record = suspension.record("coulomb", 0.0, 10.0, friction={"dynamic": mu, "static": mu})
        work.append((imposed_motion.forces(record, x, v, a, STEP)[0] * v).sum() * STEP)
    assert abs(work[0]) < 1e-9
    assert 0.0 < work[1] < work[2]


def test_beyond_lift_off_there_is_no_force():
    # A wedge spring that is stretched pulls its wedge off.
    x, v, a = sine(0.05, 2.0)
    record = suspension.record("coulomb", 0.0, 10.0)
    force = imposed_motion.forces(record, x, v, a, STEP)[0]
    assert np.isnan(force).any()
    assert np.isfinite(force).any()


def test_at_rest_set_valued_friction_is_not_determined():
    record = oscillator.record("coulomb", 0.0, 10.0, OSCILLATOR, FRICTION)
    nothing = np.zeros(10)
    assert np.isnan(imposed_motion.forces(record, nothing, nothing, nothing, STEP)).all()
