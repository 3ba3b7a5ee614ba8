"""Joints that may lift off: contacts, impacts, flight, and the bilateral model where nothing opens."""

from math import cos, inf, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import fsolve

from tests.physics import compiled_unilateral as mechanics
from tests.physics.cases import OMEGA_N
from wedgesweep import excitation, response
from wedgesweep.friction import LAW_NAMES
from wedgesweep.simulate import Settings, respond
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.period_map import memory, prepared, run_periods
from wedgesweep.solvers.trajectory import CaseError, Window
from wedgesweep.sweep import variables
from wedgesweep.systems import compact
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.unilateral.contacts import Faces, Motion

X, VELOCITY, COLUMN_GAP, COLUMN_RATE, BOLSTER_GAP, BOLSTER_RATE = range(6)
AMPLITUDE = 1e-3
MARGIN = 1e-10


FIXTURE = {"fixture_resonance": {"frequency": 40.0, "damping_ratio": 0.05}}
GUIDE = {"guide_friction": {"force": 1.5}}
OTHERS = {
    "viscous_damping": {"coefficient": 8.0},
    "end_stop": {"clearance": 1e-3, "stiffness": 2e4},
    "stribeck": {"velocity": 5e-3, "peak": 0.05},
    "input_distortion": {"second": 0.1},
}


def record(
    law="coulomb", amplitude=AMPLITUDE, beta=1.2, restitution=0.0, friction=None, effects=None, **suspension
):
    joints = {"joints": "unilateral", "restitution": restitution}
    return parameters.record(
        law, amplitude, beta * OMEGA_N, joints | suspension, friction or {}, effects or {}
    )


def vectors(p):
    """Unit vectors along and into the column, along the bolster face and into the wedge."""
    wedge, column = p["suspension"]["wedge_angle"], p["suspension"]["column_angle"]
    return (
        np.array([-sin(column), cos(column)]),
        np.array([cos(column), sin(column)]),
        np.array([sin(wedge), cos(wedge)]),
        np.array([cos(wedge), -sin(wedge)]),
    )


class Body:
    """Velocities of wedge and bolster in the plane, from a state vector."""

    def __init__(self, y, case):
        self.p = case[0]
        along, gap, self.rise = mechanics.velocities(y, compact(case))
        t_c, n_c, t_b, p_b = vectors(self.p)
        self.wedge = along * t_c - gap * n_c
        against = self.wedge - np.array([0.0, self.rise])
        self.gap_rates = -self.wedge @ n_c, against @ p_b
        self.slips = self.wedge @ t_c, against @ t_b

    @property
    def energy(self):
        s = self.p["suspension"]
        return 0.5 * s["bolster_mass"] * self.rise**2 + s["wedge_mass"] * self.wedge @ self.wedge


SPEED = st.floats(-1.0, 1.0)


@st.composite
def impacts(draw):
    """A case, a state in which a gap closes, the contacts that touch, and the restitution."""
    case = record(
        friction={"dynamic": draw(st.floats(0.0, 0.32))},
        column_angle=draw(st.sampled_from((-0.07, 0.07, 0.3))),
        wedge_mass=draw(st.floats(0.02, 1.0)),
    )
    touches = draw(st.sampled_from(((True, False), (False, True), (True, True))))
    rates = [draw(SPEED) for _ in range(2)]
    closing = draw(st.sampled_from([i for i in range(2) if touches[i]]))
    for i in range(2):
        if touches[i]:
            rates[i] = -abs(rates[i]) - 1e-3 if i == closing else 0.0
    gaps = [0.0 if touch else 1e-3 for touch in touches]
    y = (draw(st.floats(-2e-3, 2e-3)), draw(SPEED), gaps[0], rates[0], gaps[1], rates[1])
    return case, y, touches, draw(st.floats(0.0, 0.9))


@settings(max_examples=100, deadline=None, derandomize=True)
@given(impacts())
def test_an_impact_keeps_momentum_obeys_coulomb_and_never_gains_energy(given_impact):
    """And impulses are those of Moreau's law."""
    case, y, touches, restitution = given_impact
    after, impulses, unique = mechanics.struck(y, *touches, restitution, compact(case))
    assert unique
    old, new = Body(y, case), Body(after, case)
    s, (t_c, n_c, t_b, p_b) = case[0]["suspension"], vectors(case[0])
    on_bolster = impulses.bolster * p_b - impulses.bolster_friction * t_b
    on_wedge = on_bolster - impulses.column * n_c - impulses.column_friction * t_c
    assert s["wedge_mass"] * (new.wedge - old.wedge) == pytest.approx(on_wedge, abs=MARGIN)
    assert s["bolster_mass"] * (new.rise - old.rise) == pytest.approx(-2.0 * on_bolster[1], abs=MARGIN)
    assert new.energy <= old.energy * (1.0 + MARGIN)
    mu, reactions = case[0]["friction"]["mu_d"], ((impulses[0], impulses[1]), (impulses[2], impulses[3]))
    for i, (normal, friction) in enumerate(reactions):
        gap = new.gap_rates[i] + restitution * old.gap_rates[i]
        slip = new.slips[i] + restitution * old.slips[i]
        assert normal >= -MARGIN
        assert abs(friction) <= mu * normal + MARGIN
        assert abs(normal * gap) < MARGIN
        if touches[i]:
            assert gap >= -MARGIN
        if abs(slip) > 1e-6:
            assert friction == pytest.approx(mu * normal * np.sign(slip), abs=MARGIN)


def without_input(step, **suspension):
    """A case without input or friction whose "period" is a step (s), and the period map's arguments."""
    case = record("coulomb", friction={"dynamic": 0.0}, **suspension)
    excitation.set_no_motion(case, AMPLITUDE)
    case["input"]["omega"] = 2.0 * np.pi / step
    return case, prepared(compact(case)), memory(1e-10, 8, 1)


def states_after(case, y, steps):
    """States after each of some steps."""
    _, cases, room = case
    y, seen = np.array(y), []
    for i in range(steps):
        assert run_periods(cases, i, 1, y, True, room) == 0
        seen.append(y.copy())
    return np.array(seen)


@pytest.mark.acceptance
def test_free_flight_is_a_parabola():
    step, steps = 2e-3, 20
    case = without_input(step, wedge_spring=0.0)
    p = case[0][0]
    start = (0.0, 0.0, 0.5, 0.1, 0.4, 0.2)
    seen = states_after(case, start, steps)
    g, t = p["geometry"], step * np.arange(1, steps + 1)
    gravity, omega = p["suspension"]["gravity"], OMEGA_N
    # The bolster swings on its spring about its own rest, below that of the whole.
    own_rest = -p["suspension"]["bolster_mass"] * gravity / p["suspension"]["bolster_spring"] - g["rest"]
    bolster = own_rest * (1.0 - np.cos(omega * t))
    _, n_c, _, p_b = vectors(p)
    fall = -0.5 * gravity * t**2
    column = start[COLUMN_GAP] + start[COLUMN_RATE] * t - fall * n_c[1]
    face = start[BOLSTER_GAP] + start[BOLSTER_RATE] * t + (fall - bolster) * p_b[1]
    assert seen[:, X] == pytest.approx(bolster, abs=1e-9)
    assert seen[:, COLUMN_GAP] == pytest.approx(column, abs=1e-9)
    assert seen[:, BOLSTER_GAP] == pytest.approx(face, abs=1e-9)


@pytest.mark.acceptance
def test_a_bouncing_block_comes_to_rest_at_the_known_time():
    """Restitution 0.5: heights fall by 1/4, times by 1/2, and the last impact comes after 3 fall times."""
    height, restitution, lean = 1e-3, 0.5, -0.3
    gain = 9.80665 * sin(-lean)
    fall = sqrt(2.0 * height / gain)
    case = without_input(fall / 40.0, wedge_spring=0.0, column_angle=lean, restitution=restitution)
    seen = states_after(case, (0.0, 0.0, height, 0.0, 1.0, 0.0), 160)
    t = fall * np.arange(1, 161) / 40.0
    expected, speed, began = np.zeros(t.size), gain * fall, fall
    expected[t <= fall] = height - 0.5 * gain * t[t <= fall] ** 2
    for _ in range(60):
        speed *= restitution
        flight = (t > began) & (t < began + 2.0 * speed / gain)
        expected[flight] = speed * (t - began)[flight] - 0.5 * gain * (t - began)[flight] ** 2
        began += 2.0 * speed / gain
    assert began == pytest.approx(3.0 * fall)
    assert seen[:, COLUMN_GAP] == pytest.approx(expected, abs=1e-9 * height)
    assert seen[:, COLUMN_GAP].min() >= -1e-9 * height
    # Nothing bounces below the stated speed: from there on the contact is closed.
    assert np.all(seen[t > 3.0 * fall][:, (COLUMN_GAP, COLUMN_RATE)] == 0.0)


@pytest.mark.acceptance
def test_two_faces_that_hit_in_turn_ever_faster_close():
    """Rates fall by a factor with each pair of impacts, in flights down to 1e-20 s; both solvers end them."""
    suspension = {
        "wedge_mass": 0.1225,
        "bolster_mass": 0.987,
        "wedge_preload": 1.195,
        "column_angle": -0.07,
        "wedge_spring": 1600.7,
    }
    case = record("coulomb", 0.00099, 0.9188, 0.4, {"dynamic": 0.2474}, **suspension)
    window, found = Window(case["input"]["omega"][0], 0, 3, 64), []
    for solver in (event_driven, radau):
        run = solver.solve(case, window, rtol=1e-9, time_limit=inf)
        found.append((run.samples.x, run.sums["impacts"][0], run.sums["struck"][0]))
    assert found[0][1] > 80
    assert found[1][1] == pytest.approx(found[0][1], abs=4)
    assert found[1][0] == pytest.approx(found[0][0], abs=1e-6 * np.abs(found[0][0]).max())
    assert found[1][2] == pytest.approx(found[0][2], rel=1e-6)


def settled(case, periods=150, rtol=1e-8, harmonics=3):
    """Numbers after some settling periods."""
    run = Settings(method="event-driven", rtol=rtol, duration=None, settle_periods=periods, kept_periods=2)
    return respond(case, run, harmonics)[0].numbers


CASES = [
    *(("coulomb", 2.5, 1e-3, 0.3, {}), ("exponential", 1.2, 1e-3, 0.0, {})),
    ("static-dynamic", 1.0, 1e-3, 0.3, {}),
    ("exponential", 1.3, 2e-3, 0.0, FIXTURE | GUIDE),
]


@pytest.mark.acceptance
@pytest.mark.parametrize(("law", "beta", "amplitude", "restitution", "effects"), CASES)
def test_both_solvers_agree_through_impacts(law, beta, amplitude, restitution, effects):
    case = record(law, amplitude, beta, restitution, effects=effects)
    window, found = Window(beta * OMEGA_N, 3, 2, 64), []
    for solver in (event_driven, radau):
        run = solver.solve(case, window, rtol=1e-9, time_limit=inf)
        found.append(response.evaluate(run, case, harmonics=3).numbers)
    assert found[0]["impacts"] > 0.0
    names = ("amplitude_ratio", "column_open_fraction", "bolster_open_fraction", "largest_impulse")
    for name in (*names, "impacts", "impact_energy", "dissipated_energy", "supplied_energy"):
        assert found[1][name] == pytest.approx(found[0][name], rel=1e-6), name
    assert min(each["minimum_normal_force"] for each in found) > -1e-9


ENERGIES = [
    *((law, 4.75e-3, restitution, {}) for law in LAW_NAMES for restitution in (0.0, 0.5)),
    *(("coulomb", 2e-3, 0.0, FIXTURE), ("static-dynamic", 2e-3, 0.0, GUIDE)),
    ("exponential", 2e-3, 0.0, OTHERS),
]


@pytest.mark.few(2)
@pytest.mark.parametrize(("law", "amplitude", "restitution", "effects"), ENERGIES)
def test_friction_impacts_and_dampers_take_what_the_base_supplies(law, amplitude, restitution, effects):
    numbers = settled(record(law, amplitude, 0.8, restitution, effects=effects), rtol=1e-9)
    assert numbers["periodicity"] < 1e-6
    assert numbers["impact_energy"] > (0.01 if effects else 0.1) * numbers["dissipated_energy"]
    taken = numbers["dissipated_energy"] + numbers["impact_energy"]
    assert taken == pytest.approx(numbers["supplied_energy"], rel=1e-5)


def test_a_steady_response_with_impacts_is_that_of_a_long_run():
    case = record("coulomb", 1e-3, 2.5)
    expected = settled(case, 200)
    from wedgesweep.sweep.cases import solve_cases

    found = Settings(method="event-driven", rtol=1e-8, duration=None, steady=True)
    dtype = variables.record_dtype({"phase": 0, "harmonic": 9, "part": 2})
    (one,) = solve_cases(case, np.array([0]), found, inf, dtype)
    assert one["period"] == 1
    assert one["settled_periods"] < 100
    for name in ("amplitude_ratio", "impact_energy", "column_open_fraction"):
        assert one[name] == pytest.approx(expected[name], rel=1e-5), name


@pytest.mark.parametrize(
    ("name", "numbers"), [("column_compliance", {"stiffness": 1e5}), ("presliding", {"length": 1e-4})]
)
def test_effects_that_the_contacts_do_not_know_are_refused(name, numbers):
    with pytest.raises(ValueError, match=f"unilateral joints do not go with: {name}"):
        parameters.record("coulomb", 1e-3, OMEGA_N, {"joints": "unilateral"}, {}, {name: numbers})


@pytest.mark.parametrize("law", ["coulomb", "static-dynamic"])
def test_a_wedge_that_locks_is_never_a_number(law):
    case = record(law, 4.75e-3, 1.0, friction={"dynamic": 1.0, "static": 1.1}, column_angle=-0.07)
    assert not case["geometry"]["always_well_posed"][0]
    with pytest.raises(CaseError) as raised:
        event_driven.solve(case, Window(OMEGA_N, 20, 2, 64), rtol=1e-6, time_limit=inf)
    assert raised.value.status == "locked"


@pytest.mark.parametrize(("mu", "well_posed"), [(0.35, True), (0.45, False)])
def test_a_state_that_locks_while_a_jump_holds_a_velocity_is_seen(mu, well_posed):
    """Its forces would be those of one of several solutions."""
    case = record("static-dynamic", friction={"dynamic": mu, "static": 1.1 * mu}, column_angle=-0.07)
    assert not case["geometry"]["always_well_posed"][0]
    generator = np.random.default_rng(2)
    for t in generator.uniform(0.0, 2.0 * np.pi / OMEGA_N, 50):
        y = (generator.uniform(-2e-3, 2e-3), float(case["friction"]["v_t"][0]), 0.0, 0.0, 0.0, 0.0)
        asked, known = mechanics.well_posed_where_a_jump_holds(t, y, compact(case))
        assert asked == known == well_posed


def test_friction_that_presses_a_face_on_has_two_solutions_or_none():
    """Painleve: the bolster face alone, with so much friction that it pulls the faces together."""
    case = record(wedge_mass=2.0)
    s, g = case[0]["suspension"], case[0]["geometry"]
    limit = 0.5 * s["bolster_mass"] / s["wedge_mass"] + g["sin_wedge"] ** 2
    steep = Faces(False, True, True, 0.0, -2.0 * limit / (g["sin_wedge"] * g["cos_wedge"]), False)
    closing = mechanics.solve(Motion(1.0, 0.0, 0.0), steep, compact(case))
    assert closing[1] == 0
    assert closing[0].margin < 0.0
    assert mechanics.solve(Motion(-1.0, 0.0, 0.0), steep, compact(case))[1] == 2


def test_a_face_that_has_just_opened_takes_part_when_the_other_one_hits():
    """Else the impact may leave it a rate below zero at a gap of zero: another impact follows at once."""
    generator, case = np.random.default_rng(5), compact(record(restitution=0.3))
    for _ in range(200):
        rate, velocity = -generator.uniform(0.01, 1.0), generator.uniform(-1.0, 1.0)
        after = mechanics.after_bolster_closes((0.0, velocity, 0.0, 0.0, 0.0, rate), case)
        assert after[COLUMN_RATE] >= 0.0
        assert after[BOLSTER_RATE] >= 0.0


@pytest.mark.parametrize("begin", [(0.0, 1.0), (3.0, 1.0), (6.5, 1.0)])
def test_a_force_that_vanishes_is_seen_beside_loads_that_all_but_cancel(begin):
    """Both forces reach zero within 1e-6 s: what is left of one may be rounding errors of the weights."""
    case, velocity, target = compact(record(amplitude=2.5e-3)), 1.4, np.array([1.9e-6, 2.9e-15])

    def forces(at, later=0.0):
        t, x = 1e-2 * at[0] + later, 1e-3 * at[1] + velocity * later
        return np.array(mechanics.reactions_of_closed(t, (x, velocity, 0.0, 0.0, 0.0, 0.0), case))

    at = fsolve(lambda at: forces(at) - target, begin, xtol=1e-15, full_output=True)[0]
    assert forces(at) == pytest.approx(target, rel=0.1)
    falls = forces(at, 1e-6)[1] < forces(at)[1]
    y = (1e-3 * at[1], velocity, 0.0, 0.0, 0.0, 0.0)
    mode, unique = mechanics.resolve(1e-2 * at[0], y, case)
    assert unique
    assert (mode.bolster_sign == 0) == falls
