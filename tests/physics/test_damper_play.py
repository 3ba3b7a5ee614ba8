"""Play in the rod of a damper: closed forms of free and of imposed motions, and what friction holds."""

from math import inf, pi

import numpy as np
import pytest

from tests.physics.test_oscillator import OMEGA_N, SOLVERS, K, M, coulomb, oscillator
from wedgesweep.solvers import event_driven, imposed_motion
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.oscillator import parameters

pytestmark = pytest.mark.acceptance  # a kit of kernels that no other test needs
# Force of friction (N), play either way (m), and where the mass is let go (m).
FRICTION, PLAY, START = 0.2, 3e-4, 4e-3
LAWS = ("coulomb", "static-dynamic")


def free(law="coulomb", friction=FRICTION, play=PLAY, **numbers):
    """A case without input: a mass on a spring and a damper with play."""
    effects = {"damper_play": {"clearance": play}}
    given = {**coulomb(friction), "threshold_velocity": 1e-6}
    return parameters.record(law, 1e-12, OMEGA_N, oscillator(**numbers), given, effects, "force")


def turning_points(start, swings):
    """Swings lose the friction's work outside of the play: k/2 (A^2 - B^2) = F (A + B - crossing).

    The rod begins in the middle of the play, and later crosses all of it.
    """
    found, crossing = [start], PLAY
    for _ in range(swings):
        a = found[-1]
        b = np.roots([0.5 * K, FRICTION, FRICTION * (a - crossing) - 0.5 * K * a**2]).real.max()
        found.append(b)
        crossing = 2.0 * PLAY
    return np.array(found[1:])


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("law", LAWS)
def test_free_swings_lose_the_work_of_friction_outside_of_the_play(solver, law):
    expected = turning_points(START, 4)
    window = Window(OMEGA_N, 0, 2, 16384)
    x = -SOLVERS[solver].solve(free(law), window, 1e-10, inf, start=(START, 0.0)).samples.x
    inner = (x[1:-1] - x[:-2]) * (x[2:] - x[1:-1]) < 0.0
    turns = np.abs(x[1:-1][inner])[: expected.size]
    # Regularised friction is smaller below the threshold velocity, which is left at once.
    assert turns == pytest.approx(expected, rel=1e-7 if law == "coulomb" else 1e-4)


def test_in_a_play_that_is_wide_enough_nothing_damps():
    window = Window(OMEGA_N, 0, 5, 64)
    found = event_driven.solve(free(play=2.01 * START, damping=3.0), window, 1e-10, inf, start=(START, 0.0))
    assert -found.samples.x[::64] == pytest.approx(np.full(5, START), rel=1e-8)


def test_friction_holds_a_mass_against_the_side_to_which_its_rod_presses_only():
    """A mass comes to rest where the spring is stretched: friction would have to pull the rod."""
    window = Window(OMEGA_N, 0, 3, 4096)
    # The last swing ends within friction's reach of the middle, and the rod has crossed its play before.
    found = event_driven.solve(free(friction=1.5), window, 1e-10, inf, start=(START, 0.0)).samples
    held = np.flatnonzero(found.sticks)
    assert held.size == 0
    # Without play it would be held from there on.
    bare = event_driven.solve(free(friction=1.5, play=0.0), window, 1e-10, inf, start=(START, 0.0)).samples
    assert bare.sticks[-1]


def test_friction_holds_a_mass_that_presses_on_its_rod():
    """Under a slow force the mass follows it through the play, and then waits for the force of friction."""
    play, force = 3e-4, 1.0
    effects = {"damper_play": {"clearance": play}}
    numbers, slow = oscillator(damping=40.0), 1e-3 * OMEGA_N
    record = parameters.record("coulomb", force, slow, numbers, coulomb(0.4), effects, "force")
    found = event_driven.solve(record, Window(slow, 2, 1, 4096), 1e-9, inf).samples
    x, pushed = -found.x, force * np.sin(slow * (found.t - found.t[0]) + slow * found.t[0])
    # While it is held, the spring leaves between nothing and the friction for the damper, to one side.
    left, held = pushed - K * x, np.flatnonzero(found.sticks)
    phases = np.split(left[held], np.flatnonzero(np.diff(held) > 1) + 1)
    assert len(phases) > 1
    for phase in phases:
        assert np.abs(phase).max() <= 0.4 * (1.0 + 1e-6)
        assert phase.min() >= -1e-3 or phase.max() <= 1e-3


def cycle(samples, cycles=3, phase=0.3):
    angle = 2.0 * pi * np.arange(samples * cycles) / samples + phase
    return 0.01 * np.sin(angle), np.cos(angle), -np.sin(angle)


@pytest.mark.parametrize("law", ["coulomb", "static-dynamic"])
@pytest.mark.parametrize("samples", [400, 1001])
def test_a_loop_encloses_the_work_of_friction_and_damping_outside_of_the_play(law, samples):
    amplitude, play, damping, mu, step = 0.01, 2e-3, 5.0, 0.4, 1.0 / samples
    effects = {"damper_play": {"clearance": play}}
    numbers = {"mass": M, "spring": K, "damping": damping, "normal_force": 2.0}
    record = parameters.record(law, 0.0, 1.0, numbers, coulomb(mu), effects)
    x, v, a = cycle(samples)
    v, a = amplitude * 2.0 * pi * v, amplitude * (2.0 * pi) ** 2 * a
    force = imposed_motion.forces(record, x, v, a, step)[0]
    later = slice(samples, 2 * samples)
    area = (force * v)[later].sum() * step
    # Crossing: from a turn on over two clearances.
    crossed = np.arccos(1.0 - 2.0 * play / amplitude)
    viscous = damping * amplitude**2 * 2.0 * pi * (2.0 * (pi - crossed) + np.sin(2.0 * crossed)) / 2.0
    expected = 4.0 * 2.0 * mu * (amplitude - play) + viscous
    assert area == pytest.approx(expected, rel=0.5 / samples)
    inside = (force - M * a - K * x)[later]
    nothing = np.abs(inside) < 1e-3 * 2.0 * mu
    assert nothing.mean() == pytest.approx(crossed / pi, abs=4.0 / samples)


def test_the_zero_of_an_imposed_motion_does_not_move_the_rod():
    effects = {"damper_play": {"clearance": 2e-3}}
    numbers = {"mass": M, "spring": 0.0, "damping": 5.0, "normal_force": 2.0}
    record = parameters.record("coulomb", 0.0, 1.0, numbers, coulomb(0.4), effects)
    x, v, a = cycle(500)
    v, a = 0.02 * pi * v, 0.04 * pi**2 * a
    stepped = x + 0.1 * (np.arange(x.size) > 700)
    forces = [imposed_motion.forces(record, each, v, a, 2e-3) for each in (x, stepped)]
    np.testing.assert_array_equal(*forces)
