"""Constant damping: springs of wedges that stand on the bolster, so that friction does not depend on load."""

from itertools import product
from math import cos, inf, sin

import numpy as np
import pytest

from tests.physics import compiled_unilateral
from tests.physics.cases import OMEGA_N, TABLE_1, evaluated, fast
from tests.physics.effect_cases import EXTENDING
from tests.physics.test_newton import check, record_of
from tests.physics.test_unilateral import vectors
from wedgesweep import response
from wedgesweep.friction import LAW_NAMES
from wedgesweep.solvers import event_driven, imposed_motion, radau
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems import compact
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.equilibrium import resonance
from wedgesweep.systems.suspension.rest import breakaway_accelerations

PRELOAD = 4.0  # N
CONSTANT = {"damping": "constant", "wedge_preload": PRELOAD}
LEANS = (-0.07, 0.07)


def record(law="coulomb", amplitude=1e-3, beta=0.6, friction=None, effects=None, **suspension):
    return parameters.record(
        law, amplitude, beta * OMEGA_N, CONSTANT | suspension, friction or {}, effects or {}
    )


@pytest.mark.few(3)
@pytest.mark.parametrize(("law", "lean"), list(product(LAW_NAMES, (*LEANS, 0.0))))
def test_forces_solve_newtons_equations_as_vectors(law, lean):
    """Also with each effect in turn: columns that yield raise the wedge, and tables move both bodies."""
    generator = np.random.default_rng(1)
    names = [[], *([name] for name in EXTENDING)] if lean else [[]]
    stiff = {"wedge_spring": 2e4}  # so that its force is no small one
    unique = [
        check(record_of(law, generator, each, lean, **CONSTANT, **stiff), generator)
        for each in names
        for _ in range(10)
    ]
    assert sum(unique) >= 0.8 * len(unique)


@pytest.mark.acceptance
def test_free_bodies_fly_under_the_spring_between_them():
    """Both contacts open: wedge and bolster as vectors, each under its spring and weight."""
    generator = np.random.default_rng(2)
    case = record(joints="unilateral", restitution=0.0)
    s, (t_c, n_c, _, p_b) = case[0]["suspension"], vectors(case[0])
    for _ in range(50):
        x, speed, *gaps = generator.uniform(-2e-3, 2e-3, 6)
        y = (x, speed, abs(gaps[0]), gaps[1], abs(gaps[2]), gaps[3])
        z, t = case[0]["geometry"]["rest"] + x, generator.uniform(0.0, 1.0)
        wedge = np.linalg.solve([n_c, p_b], [-y[2], y[4] + z * p_b[1]])
        force = PRELOAD - s["wedge_spring"] * (wedge[1] - z)
        base = -1e-3 * (0.6 * OMEGA_N) ** 2 * sin(0.6 * OMEGA_N * t)
        of_wedge = np.array([0.0, force / s["wedge_mass"] - s["gravity"] - base])
        of_bolster = -(s["bolster_spring"] * z + 2.0 * force) / s["bolster_mass"] - s["gravity"] - base
        expected = speed, of_bolster, y[3], -of_wedge @ n_c, y[5], (of_wedge - [0.0, of_bolster]) @ p_b
        assert compiled_unilateral.rate_at(t, y, compact(case)) == pytest.approx(expected, rel=1e-9)
    assert t_c @ n_c == pytest.approx(0.0, abs=1e-15)  # some processors round the products, others their sum


@pytest.mark.parametrize("lean", LEANS)
def test_equilibrium_and_resonance_by_virtual_work(lean):
    """Per rise of the bolster the wedge rises by r cos(gamma), and its spring lengthens by less 1."""
    case = record(column_angle=lean)[0]
    s, ratio = case["suspension"], sin(s_angle := TABLE_1["wedge_angle"]) / sin(s_angle + lean)
    rise = ratio * cos(lean)
    stiffness = s["bolster_spring"] + 2.0 * s["wedge_spring"] * (rise - 1.0) ** 2
    weight = (s["bolster_mass"] + 2.0 * s["wedge_mass"] * rise) * s["gravity"]
    assert case["geometry"]["rest"] == pytest.approx((2.0 * PRELOAD * (rise - 1.0) - weight) / stiffness)
    mass = s["bolster_mass"] + 2.0 * s["wedge_mass"] * ratio**2
    assert resonance(compact(record(column_angle=lean))[0]) == pytest.approx((stiffness / mass) ** 0.5)


def work_per_cycle(damping, bolster_mass):
    """Friction's work (J) over a slow cycle of 0.1 mm that is imposed on the bolster."""
    turn = 2.0 * np.pi * (np.arange(4096) + 0.5) / 4096
    omega, stroke = 0.1, 1e-4
    motion = stroke * np.sin(turn), stroke * omega * np.cos(turn), -stroke * omega**2 * np.sin(turn)
    case = record("static-dynamic", column_angle=0.0, damping=damping, bolster_mass=bolster_mass)
    case["friction"]["v_t"] = 1e-9
    force = imposed_motion.forces(case, *motion, turn[1] / omega - turn[0] / omega)[0]
    return force @ motion[1] * (turn[1] - turn[0]) / omega


def test_without_lean_friction_does_not_depend_on_the_load():
    constant = [work_per_cycle("constant", mass) for mass in (0.3, 0.7, 7.0)]
    assert constant == pytest.approx([constant[0]] * 3, rel=1e-9)
    empty, loaded = (work_per_cycle("variable", mass) for mass in (0.3, 1.5))
    assert loaded > 1.4 * empty


@pytest.mark.parametrize("bolster_mass", [1.5, 3.0])
@pytest.mark.parametrize("stiffness", [0.0, 2550.0])
def test_without_lean_and_mass_of_the_wedge_its_force_is_constant(bolster_mass, stiffness):
    """N_c = F_w0 cos(a) / (sin(a) + mu cos(a)) in slip up, and with -mu in slip down, whatever moves."""
    case = record(
        "static-dynamic",
        3e-3,
        column_angle=0.0,
        wedge_mass=0.0,
        wedge_spring=stiffness,
        bolster_mass=bolster_mass,
    )
    found, a, mu = fast(case, 5).waveforms, TABLE_1["wedge_angle"], 0.29
    slips = ~found["stuck"].astype(bool)
    up = np.sign(-found["velocity"][slips])  # the dataset has side frame minus bolster
    expected = PRELOAD * cos(a) / (sin(a) + mu * up * cos(a))
    assert slips.mean() > 0.2
    assert set(up) == {-1.0, 1.0}
    assert found["normal_force_column"][slips] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("law", LAW_NAMES)
def test_without_stiffness_it_is_the_other_kind_lower_on_its_springs(law):
    """The spring's force is constant then; its reaction only moves the rest position of the bolster."""
    kinds = [record(law, wedge_spring=0.0, damping=kind) for kind in parameters.DAMPING]
    variable, constant = (fast(case, 10).numbers for case in kinds)
    # The solver counts displacement from rest, with which rounding differs.
    for name in ("amplitude_ratio", "stick_fraction", "minimum_normal_force", "dissipated_energy"):
        assert constant[name] == pytest.approx(variable[name], rel=1e-7), name
    lower = kinds[0]["geometry"]["rest"] - kinds[1]["geometry"]["rest"]
    assert lower == pytest.approx(2.0 * PRELOAD / TABLE_1["bolster_spring"])


@pytest.mark.few(3)
@pytest.mark.parametrize("lean", LEANS)
@pytest.mark.parametrize("law", LAW_NAMES)
def test_energy_balance_over_a_steady_period(law, lean):
    found = fast(record(law, 2e-3, 0.9, column_angle=lean), 1000).numbers
    assert found["dissipated_energy"] > 0.0
    assert found["dissipated_energy"] == pytest.approx(found["supplied_energy"], rel=2e-7)


def test_energy_balance_where_wedges_lift_off():
    """Springs of wedges that fly give back what they take; impacts take their share."""
    found = solved(event_driven.solve, record(amplitude=2e-3, beta=0.8, joints="unilateral"), 200)
    assert min(found["column_open_fraction"], found["bolster_open_fraction"], found["impact_energy"]) > 0.0
    taken = found["dissipated_energy"] + found["impact_energy"]
    assert taken == pytest.approx(found["supplied_energy"], rel=1e-6)


def solved(solve, case, settle):
    window = Window(float(case["input"]["omega"][0]), settle, 2, 256)
    return response.evaluate(solve(case, window, 1e-9, inf), case, harmonics=9).numbers


@pytest.mark.acceptance
@pytest.mark.parametrize("law", LAW_NAMES)
@pytest.mark.parametrize(
    ("joints", "amplitude", "beta"), [("bilateral", 1e-3, 0.6), ("unilateral", 2e-3, 0.8)]
)
def test_both_solvers_agree(law, joints, amplitude, beta):
    case = record(law, amplitude, beta, joints=joints)
    one, other = (solved(solve, case, 5) for solve in (event_driven.solve, radau.solve))
    assert (one["lift_off_fraction"] > 0.0) == (joints == "unilateral")
    for name in ("amplitude_ratio", "stick_fraction", "dissipated_energy", "lift_off_fraction"):
        assert other[name] == pytest.approx(one[name], rel=1e-6, abs=1e-6), name


@pytest.mark.parametrize("lean", LEANS)
def test_the_bolster_breaks_away_where_the_band_says(lean):
    least = float(breakaway_accelerations(record(column_angle=lean))[0][0])
    for share, sticks in ((0.999, True), (1.001, False)):
        case = record(amplitude=share * least / OMEGA_N**2, beta=1.0, column_angle=lean)
        assert (evaluated(case, 2).numbers["stick_fraction"] == 1.0) == sticks
