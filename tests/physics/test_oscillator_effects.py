"""Effects on the oscillator: each balances its energy, in both solvers; at its neutral value it is absent."""

from math import inf, pi

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid
from scipy.optimize import brentq

from tests.physics.effect_cases import tabulated
from tests.physics.test_oscillator import (
    AMPLITUDE,
    EACH_SOLVER,
    OMEGA_N,
    SOLVERS,
    K,
    M,
    coulomb,
    oscillator,
    steady,
)
from wedgesweep.effects import EFFECTS
from wedgesweep.solvers import event_driven
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.oscillator import parameters

# Strengths that change the response by some per cent or more, in SI units.
STRENGTHS = {
    "bolster_stiffness": {"scale": 1.1},
    "bolster_mass": {"scale": 0.9},
    "friction_level": {"scale": 1.3},
    "damping_level": {"scale": 2.0},
    "stribeck": {"peak": 0.2, "velocity": 0.01},
    "presliding": {"length": 2e-4},
    "ageing": {"rate": 0.02, "time": 0.01},
    "directional_friction": {"asymmetry": 0.3},
    "position_friction": {
        **{"share": 0.5, "share_phase": 0.4, "wavelength": 5e-3},
        **{"second": 0.8, "second_phase": -1.0},
    },
    "damper_play": {"clearance": 3e-4},
    "series_compliance": {"stiffness": 1e4, "coefficient": 3.0},
    "viscous_damping": {"coefficient": 5.0},
    "directional_damping": {"coefficient": 5.0, "asymmetry": 0.6},
    "quadratic_drag": {"coefficient": 100.0},
    "degressive_damping": {"coefficient": 20.0, "velocity": 0.03, "asymmetry": 0.4, "exponent": 0.5},
    "cubic_stiffness": {"coefficient": 4e7},
    "asymmetric_spring": {"asymmetry": 0.3},
    "backlash": {"clearance": 3e-4},
    "guide_friction": {"force": 0.2},
    "end_stop": {"clearance": 1e-3, "stiffness": 500.0},
    "empirical_force": tabulated(2e-3, 0.1),
    "input_distortion": {"second": 0.1, "second_phase": 0.4, "third": 0.05, "third_phase": -1.0},
    "displacement_gain": {"scale": 1.02},
    "input_gain": {"scale": 1.05},
    "load_dependent_friction": {"exponent": 0.2, "reference": 3.0},
    "thermal_drift": {"share": -0.004, "temperature": 60.0, "reference": 20.0},
}
# Those on what lies between mass and base are also tried where the mass rubs on something else.
SENSORS = ("velocity_lag", "force_gain", "channel_delay")
GROUNDED = ("directional_damping", "cubic_stiffness", "backlash", "end_stop", "input_distortion")
MECHANICAL = [name for name in STRENGTHS if name != "displacement_gain"]


def case(law="coulomb", contact="base", level=0.5, **effects):
    numbers = oscillator(damping=6.0, contact=contact)
    friction = {**coulomb(level), "threshold_velocity": 2e-3}
    return parameters.record(law, AMPLITUDE, 0.8 * OMEGA_N, numbers, friction, effects)


def test_every_effect_of_the_oscillator_is_tried():
    elsewhere = {*SENSORS, "stray_vibration", "maxwell_presliding"}  # the last has a kit of its own
    assert set(STRENGTHS) == set(parameters.effect_names()) - elsewhere


@pytest.mark.parametrize("name", parameters.effect_names())
def test_words_name_parts_of_the_oscillator(name):
    words = EFFECTS[name].described("oscillator")
    assert not any(part in words for part in ("bolster", "wedge", "column", "side frame", "{"))


def case_of(name, law, numbers):
    """A case with one effect, where it shows."""
    contact = "ground" if name in GROUNDED else "base"
    # Time at rest strengthens friction only where there is some.
    return case(law, contact, 0.9 if name == "ageing" else 0.5, **{name: numbers})


@pytest.mark.parametrize("law", ["coulomb", "exponential"])
@pytest.mark.parametrize("name", MECHANICAL)
def test_energy_balances(name, law):
    found = steady(case_of(name, law, STRENGTHS[name]), rtol=1e-8, settle=30).numbers
    assert found["supplied_energy"] == pytest.approx(found["dissipated_energy"], rel=2e-5)
    neutral = {each.name: each.neutral * each.factor for each in EFFECTS[name].quantities}
    without = steady(case_of(name, law, neutral), rtol=1e-8, settle=30).numbers
    # Friction that differs by direction moves the mean only.
    changed = "mean_displacement" if name == "directional_friction" else "amplitude_ratio"
    assert abs(found[changed] - without[changed]) > 1e-3 * abs(found[changed])


@pytest.mark.acceptance
@pytest.mark.parametrize("name", MECHANICAL)
def test_solvers_agree(name):
    """Also before the response is steady."""
    effect = case_of(name, "coulomb", STRENGTHS[name])
    one, other = (steady(effect, solver, rtol=1e-8, settle=2).numbers for solver in SOLVERS)
    # Bristles have no event where the slip velocity passes the bound of sticking: its share is a quadrature.
    for number in ("amplitude_ratio", "dissipated_energy", *["stick_fraction"] * (name != "presliding")):
        assert one[number] == pytest.approx(other[number], rel=1e-5, abs=1e-6), number


@pytest.mark.acceptance
@pytest.mark.parametrize("level", [0.5, 1.5])
def test_bent_bristles_hold_a_mass_between_the_frictions_of_both_directions(level):
    """At zero slip friction jumps by the asymmetry times what the bristles hold."""
    both = {name: STRENGTHS[name] for name in ("presliding", "directional_friction")}
    found = [steady(case("coulomb", level=level, **both), each, rtol=1e-8, settle=30) for each in SOLVERS]
    for number in ("amplitude_ratio", "mean_displacement", "dissipated_energy"):
        one, other = (each.numbers[number] for each in found)
        assert one == pytest.approx(other, rel=1e-5, abs=1e-9), number
    for each in found:
        assert each.numbers["supplied_energy"] == pytest.approx(each.numbers["dissipated_energy"], rel=2e-5)


@pytest.mark.parametrize(("side", "factor"), [(1.0, 0.7), (-1.0, 1.3)])
def test_friction_by_direction_leaves_the_friction_of_the_guide(side, factor):
    """A spring that is stretched pulls downward; friction of the surface is weaker against that."""
    effects = {"directional_friction": {"asymmetry": 0.3}, "guide_friction": {"force": 0.2}}
    record = case(contact="ground", **effects)
    record["input"]["amplitude"] = 1e-9
    for share, sticks in ((0.99, True), (1.01, False)):
        start = (side * share * (factor * 0.5 + 0.2) / K, 0.0)
        run = event_driven.solve(record, Window(OMEGA_N, 0, 2, 64), 1e-8, inf, start=start)
        assert run.samples.sticks[0] == sticks


@pytest.mark.parametrize("name", STRENGTHS)
def test_neutral_values_change_nothing(name):
    neutral = {each.name: each.neutral * each.factor for each in EFFECTS[name].quantities}
    assert case(**{name: neutral}) == case()


@pytest.mark.parametrize(
    ("effects", "held"),
    [({}, 0.5 / K), ({"cubic_stiffness": {"coefficient": 4e7}}, np.roots([4e7, 0.0, K, -0.5]).real.max())],
)
def test_friction_holds_the_springs_up_to_its_level(effects, held):
    record = case(contact="ground", **effects)
    record["input"]["amplitude"] = 1e-9
    for share, sticks in ((0.99, True), (1.01, False)):
        run = event_driven.solve(record, Window(OMEGA_N, 0, 2, 64), 1e-8, inf, start=(share * held, 0.0))
        assert run.samples.sticks[0] == sticks


def free(solver, x, **effects):
    """A run of the undamped mass without friction, released at x, for two periods of its linear vibration."""
    record = parameters.record(
        "coulomb", 1e-9, OMEGA_N, oscillator(normal_force=0.0), coulomb(0.0), effects, "force"
    )
    window = Window(OMEGA_N, 0, 2, 8192)
    return SOLVERS[solver].solve(record, window, 1e-11, inf, start=(x, 0.0)).samples


@EACH_SOLVER
@pytest.mark.parametrize("asymmetry", [0.6, -0.6])
def test_damping_by_direction_decays_at_the_rate_of_each_half_swing(solver, asymmetry):
    mean = 8.0
    samples = free(solver, 2e-3, directional_damping={"coefficient": mean, "asymmetry": asymmetry})
    # State and recorded deflection have opposite signs.
    x = -samples.x
    assert x[0] == pytest.approx(2e-3)
    swings = []
    for damping in (mean * (1.0 - asymmetry), mean * (1.0 + asymmetry)):  # down, then up
        ratio = damping / (2.0 * M * OMEGA_N)
        swings.append(np.exp(-pi * ratio / np.sqrt(1.0 - ratio**2)))
    turns = np.array([-swings[0], swings[0] * swings[1]]) * 2e-3
    assert [x.min(), x[x.size // 4 :].max()] == pytest.approx(turns, rel=1e-6)


@EACH_SOLVER
def test_drag_has_the_turning_points_of_its_first_integral(solver):
    """From x = -A to B at positive speed: (1 - g B) exp(g B) = (1 + g A) exp(-g A), g = 2 c/m."""
    coefficient, start = 300.0, 2e-3
    g = 2.0 * coefficient / M
    turn = brentq(
        lambda x: (1.0 - g * x) * np.exp(g * x) - (1.0 + g * start) * np.exp(-g * start), 1e-4, start
    )
    x = -free(solver, -start, quadratic_drag={"coefficient": coefficient}).x
    assert x.max() == pytest.approx(turn, rel=1e-6)


@EACH_SOLVER
def test_play_lengthens_the_period_by_the_time_of_its_crossing(solver):
    """Force-free for 2 clearances, twice a period, at the speed of the linear motion there."""
    clearance, start = 4e-4, 2e-3
    samples = free(solver, start, backlash={"clearance": clearance})
    crossing = 4.0 * clearance / (OMEGA_N * (start - clearance))
    t, v = samples.t[1:] - samples.t[0], samples.velocity[1:]
    last = np.flatnonzero(np.diff(np.sign(v)))[:2]
    turns = t[last] - v[last] * (t[last + 1] - t[last]) / (v[last + 1] - v[last])
    period = 2.0 * pi / OMEGA_N + crossing
    assert turns == pytest.approx([0.5 * period, period], rel=1e-6)
    assert np.abs(samples.x).max() == pytest.approx(start, rel=1e-6)


@EACH_SOLVER
@pytest.mark.parametrize("asymmetry", [0.4, -0.4])
def test_a_spring_that_is_stiffer_to_one_side_swings_farther_and_longer_to_the_other(solver, asymmetry):
    start = 2e-3
    samples = free(solver, start, asymmetric_spring={"asymmetry": asymmetry})
    ratio = np.sqrt((1.0 + asymmetry) / (1.0 - asymmetry))
    assert [-samples.x.max(), -samples.x.min()] == pytest.approx([-start * ratio, start], rel=1e-6)
    t, v = samples.t[1:] - samples.t[0], samples.velocity[1:]
    last = np.flatnonzero(np.diff(np.sign(v)))[:2]
    turns = t[last] - v[last] * (t[last + 1] - t[last]) / (v[last + 1] - v[last])
    quarters = 0.5 * pi / OMEGA_N / np.sqrt([1.0 + asymmetry, 1.0 - asymmetry])
    assert turns == pytest.approx([quarters.sum(), 2.0 * quarters.sum()], rel=1e-6)


@pytest.mark.parametrize("asymmetry", [0.0, 0.5])
def test_degressive_damping_is_viscous_when_slow_and_friction_when_fast(asymmetry):
    start, coefficient = 2e-3, 6.0

    def swings(**effects):
        x = -free("event-driven", start, **effects).x
        return np.array([x.min(), x[x.size // 4 : 3 * x.size // 4].max()])

    def degressive(coefficient, velocity):
        numbers = {"coefficient": coefficient, "velocity": velocity, "asymmetry": asymmetry, "exponent": 0.0}
        return swings(degressive_damping=numbers)

    viscous = swings(directional_damping={"coefficient": coefficient, "asymmetry": asymmetry})
    assert degressive(coefficient, 1e5) == pytest.approx(viscous, rel=1e-5)
    # Dry friction F takes 2F/k of each swing.
    force, slow = 0.05 * K * start, 1e-5
    lost = 2.0 * force / K * np.array([1.0 - asymmetry, 1.0 + asymmetry])
    dry = [-start + lost[0], start - lost.sum()]
    assert degressive(force / slow, slow) == pytest.approx(dry, rel=1e-3)


@pytest.mark.parametrize("second", [0.0, 0.3, 1.2], ids=["one harmonic", "two", "none at some places"])
@EACH_SOLVER
def test_friction_along_the_stroke_takes_its_work_from_a_free_swing(solver, second):
    """k/2 (A^2 - B^2) = F times the integral of the factor from one turn to the next."""
    start, force, share, phase, length, later = 2e-3, 0.2, 0.6, 0.7, 5e-3, -0.4
    effect = {"share": share, "share_phase": phase, "wavelength": length}
    effect |= {"second": second, "second_phase": later}
    numbers = oscillator(normal_force=1.0)
    record = parameters.record(
        "coulomb", 1e-12, OMEGA_N, numbers, coulomb(force), {"position_friction": effect}, "force"
    )
    run = SOLVERS[solver].solve(record, Window(OMEGA_N, 0, 1, 4096), 1e-11, inf, start=(start, 0.0))

    place = np.linspace(start, -start, 200001)
    angle = 2.0 * pi * place / length
    factor = 1.0 + share * np.sin(angle + phase) + second * np.sin(2.0 * angle + later)
    assert (second > 1.0) == (factor.min() < 0.0)
    work = force * cumulative_trapezoid(np.maximum(factor, 0.0), -place, initial=0.0)
    turn = np.argmax((0.5 * K * (start**2 - place**2) <= work) & (place < -0.1 * start))
    assert -run.samples.x.max() == pytest.approx(place[turn], rel=2e-5)
