"""The oscillator against closed forms and published numbers."""

from math import inf, pi, sqrt

import numpy as np
import pytest
from reproduce.published import measured

from tests.physics.test_den_hartog import closed_form
from wedgesweep import excitation, response
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.oscillator import parameters

SOLVERS = {"event-driven": event_driven, "radau": radau}
# Effects are compiled for the slow solver in `make acceptance` only.
EACH_SOLVER = pytest.mark.parametrize(
    "solver", ["event-driven", pytest.param("radau", marks=pytest.mark.acceptance)]
)
M, K = 2.0, 800.0
OMEGA_N = sqrt(K / M)
AMPLITUDE = 2e-3


def oscillator(**numbers):
    return {"mass": M, "spring": K, "damping": 0.0, "normal_force": 1.0, "contact": "base", **numbers}


def coulomb(coefficient):
    return {"dynamic": coefficient, "static": coefficient}


def steady(case, solver="event-driven", rtol=1e-12, settle=600, periods=2, samples=256):
    window = Window(float(case["input"]["omega"][0]), settle, periods, samples)
    return response.evaluate(SOLVERS[solver].solve(case, window, rtol, time_limit=600.0), case, harmonics=9)


@pytest.mark.parametrize(("r", "force_ratio"), [(0.6, 0.05), (0.8, 0.5), (1.2, 0.3), (2.0, 0.5)])
def test_den_hartog_under_a_force(r, force_ratio):
    force = 3.0
    case = parameters.record(
        "coulomb", force, r * OMEGA_N, oscillator(), coulomb(force_ratio * force), input_kind="force"
    )
    found = steady(case).numbers
    assert found["stick_fraction"] == 0.0
    assert found["amplitude_ratio"] == pytest.approx(closed_form(r, force_ratio), rel=1e-8)


@pytest.mark.parametrize(("r", "force_ratio"), [(0.8, 0.5), (1.5, 0.3)])
def test_den_hartog_on_a_base(r, force_ratio):
    omega = r * OMEGA_N
    friction = coulomb(force_ratio * M * omega**2 * AMPLITUDE)
    found = steady(parameters.record("coulomb", AMPLITUDE, omega, oscillator(), friction)).numbers
    assert found["amplitude_ratio"] / r**2 == pytest.approx(closed_form(r, force_ratio), rel=1e-8)


@pytest.mark.parametrize("damping", [0.0, 12.0])
def test_wall_friction_on_a_moving_base_is_that_under_the_force_of_spring_and_damper(damping):
    omega = 0.9 * OMEGA_N
    rubbing = oscillator(damping=damping, contact="ground")
    samples = 4096  # sampled from one phase or another, harmonics beyond the samples must be small
    moved = steady(parameters.record("coulomb", AMPLITUDE, omega, rubbing, coulomb(0.8)), samples=samples)
    # k u + c u' = sqrt(k^2 + c^2 omega^2) a sin(omega t + lead)
    force, lead = AMPLITUDE * np.hypot(K, damping * omega), np.arctan2(damping * omega, K)
    case = parameters.record("coulomb", force, omega, rubbing, coulomb(0.8), input_kind="force")
    pushed = steady(case, samples=samples)
    assert moved.numbers["peak_to_peak"] == pytest.approx(pushed.numbers["peak_to_peak"], rel=1e-9)
    turn = np.exp(1j * lead * np.arange(1, 10))
    first, second = (each.spectra["displacement_harmonics"] @ [1.0, 1j] for each in (moved, pushed))
    assert first == pytest.approx(second * turn, rel=1e-6, abs=1e-9 * AMPLITUDE)
    lag = pushed.numbers["phase_lag"] - lead
    assert moved.numbers["phase_lag"] == pytest.approx(lag, abs=1e-8)


@pytest.mark.parametrize("r", [0.3, 2.5])
def test_a_mass_on_a_fast_belt_is_a_linear_oscillator_with_a_constant_load(r):
    """It slips in one direction for the whole window, which is one mode of many scanned intervals."""
    force, damping, friction, belt, omega = 3.0, 12.0, 0.4, 1.0, r * OMEGA_N
    on_belt = oscillator(damping=damping, contact="belt", belt_velocity=belt)
    case = parameters.record("coulomb", force, omega, on_belt, coulomb(friction), input_kind="force")
    found = steady(case, settle=100, periods=4).numbers
    amplitude = force / abs(K - M * omega**2 + 1j * damping * omega)
    assert found["amplitude_ratio"] == pytest.approx(amplitude * K / force, rel=1e-9)
    assert found["peak_velocity"] == pytest.approx(amplitude * omega, rel=1e-9)
    assert found["mean_displacement"] == pytest.approx(friction / K, rel=1e-9)
    taken = pi * damping * omega * amplitude**2 + friction * belt * 2.0 * pi / omega
    assert found["dissipated_energy"] == pytest.approx(taken, rel=1e-9)
    assert found["supplied_energy"] == pytest.approx(taken, rel=1e-9)


# A block on a belt (Leine et al., 1998): k = m = F_s = 1, belt 0.2, F = F_s / (1 + 3 |v|).
BLOCK = {"mass": 1.0, "spring": 1.0, "normal_force": 1.0, "contact": "belt", "belt_velocity": 0.2}
HYPERBOLIC = {"static": 1.0, "threshold_velocity": 1.0 / 3.0}


@EACH_SOLVER
def test_block_on_a_belt(solver):
    case = parameters.record("hyperbolic", 0.0, 2.0 * pi / 12.0, BLOCK, HYPERBOLIC, input_kind="force")
    run = SOLVERS[solver].solve(case, Window(2.0 * pi / 12.0, 5, 3, 16384), 1e-10, inf)
    cycle = measured(run.samples.t, -run.samples.x, -run.samples.velocity, run.samples.sticks, 0.2)
    assert cycle.period == pytest.approx(12.00103, abs=1e-5)
    assert cycle.slip == pytest.approx(4.29600, abs=1e-5)
    assert cycle.stick == pytest.approx(7.70503, abs=1e-5)
    assert cycle.sticks_from == pytest.approx(-0.5410064, abs=1e-6)
    assert cycle.highest == pytest.approx(1.1339447, abs=1e-6)
    assert cycle.lowest == pytest.approx(-0.5554327, abs=1e-6)
    assert -run.sums["lowest"][0] == pytest.approx(1.1339447, abs=1e-7)
    assert -run.sums["highest"][0] == pytest.approx(-0.5554327, abs=1e-7)


@pytest.mark.acceptance
@pytest.mark.parametrize("excitation", ["base", "force"])
@pytest.mark.parametrize(
    ("law", "contact"),
    [("coulomb", "base"), ("static-dynamic", "ground"), ("exponential", "belt"), ("hyperbolic", "base")],
)
def test_energy_balances_and_solvers_agree(law, contact, excitation):
    numbers = oscillator(damping=6.0, contact=contact, belt_velocity=0.05)
    friction = {"dynamic": 0.5, "static": 0.6, "threshold_velocity": 2e-3}
    amplitude = AMPLITUDE if excitation == "base" else AMPLITUDE * K
    case = parameters.record(law, amplitude, 0.7 * OMEGA_N, numbers, friction, input_kind=excitation)
    settled = steady(case, rtol=1e-8, settle=30).numbers
    assert settled["supplied_energy"] == pytest.approx(settled["dissipated_energy"], rel=1e-5)
    found = [steady(case, solver, rtol=1e-8, settle=4).numbers for solver in SOLVERS]
    for name in ("amplitude_ratio", "dissipated_energy", "stick_fraction", "phase_lag"):
        assert found[0][name] == pytest.approx(found[1][name], rel=1e-5, abs=1e-7), name


@pytest.mark.parametrize("contact", ["base", "ground"])
def test_recorded_base_motion(contact):
    """Without friction each harmonic of the base's motion passes by itself."""
    omega, damping = 0.4 * OMEGA_N, 12.0
    case = parameters.record(
        "coulomb", AMPLITUDE, omega, oscillator(damping=damping, contact=contact), coulomb(0.0)
    )
    shape = np.array([-1j, 0.1 + 0.2j, -0.05j])
    excitation.set_series(case, shape)
    orders = np.arange(1, 4)
    dynamic = K + 1j * damping * orders * omega
    numerator = dynamic if contact == "ground" else M * (orders * omega) ** 2
    expected = AMPLITUDE * shape * numerator / (dynamic - M * (orders * omega) ** 2)
    found = steady(case, settle=100).spectra["displacement_harmonics"] @ [1.0, 1j]
    assert found[:3] == pytest.approx(expected, rel=1e-9)
