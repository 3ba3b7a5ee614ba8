"""Wedges that lift off with a guide that rubs on the bolster, or with a side frame on a compliant table."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from tests.physics import compiled_unilateral as mechanics
from tests.physics.cases import OMEGA_N
from tests.physics.compiled_mechanics import reactions
from tests.physics.test_unilateral import FIXTURE, GUIDE, MARGIN, SPEED, record, settled, vectors
from wedgesweep.solvers.period_map import memory, prepared, run_periods
from wedgesweep.systems import compact
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.newton import Coefficients, Loads
from wedgesweep.systems.suspension.unilateral.contacts import Faces, Motion

# A side frame that an impact moves


@st.composite
def impacts(draw):
    """A case, a state in which gaps close, the contacts that touch, and the restitution."""
    case = record(
        effects=FIXTURE,
        friction={"dynamic": draw(st.floats(0.0, 0.3))},
        column_angle=draw(st.sampled_from((-0.07, 0.07, 0.3))),
        wedge_mass=draw(st.floats(0.02, 0.6)),
        side_frame_mass=draw(st.floats(0.1, 2.0)),
    )
    touches = draw(st.sampled_from(((True, False), (False, True), (True, True))))
    rates = [-abs(draw(SPEED)) - 1e-3 if touch else draw(SPEED) for touch in touches]
    gaps = [0.0 if touch else 1e-3 for touch in touches]
    y = (0.0, draw(SPEED), 0.0, draw(SPEED), gaps[0], rates[0], gaps[1], rates[1])
    return case, y, touches, draw(st.floats(0.0, 0.9))


def velocities(y, case):
    """Of wedge, bolster and side frame against the table."""
    along, gap, rise = mechanics.velocities(y, compact(case))
    t_c, n_c, _, _ = vectors(case[0])
    frame = np.array([0.0, y[3]])
    return along * t_c - gap * n_c + frame, rise + y[3], y[3]


@settings(max_examples=100, deadline=None, derandomize=True)
@given(impacts())
def test_impulses_move_wedge_bolster_and_side_frame_and_take_energy(given_impact):
    case, y, touches, restitution = given_impact
    assert case["geometry"]["always_well_posed"][0]
    after, now, unique = mechanics.struck(y, *touches, restitution, compact(case))
    assert unique
    s, (t_c, n_c, t_b, p_b) = case[0]["suspension"], vectors(case[0])
    on_bolster = now.bolster * p_b - now.bolster_friction * t_b
    on_frame = now.column * n_c + now.column_friction * t_c
    (wedge, bolster, frame), old = velocities(after, case), velocities(y, case)
    assert s["wedge_mass"] * (wedge - old[0]) == pytest.approx(on_bolster - on_frame, abs=MARGIN)
    assert s["bolster_mass"] * (bolster - old[1]) == pytest.approx(-2.0 * on_bolster[1], abs=MARGIN)
    assert s["side_frame_mass"] * (frame - old[2]) == pytest.approx(2.0 * on_frame[1], abs=MARGIN)

    def energy(moving):
        wedge, bolster, frame = moving
        own = s["wedge_mass"] * wedge @ wedge + 0.5 * s["bolster_mass"] * bolster**2
        return own + 0.5 * s["side_frame_mass"] * frame**2

    assert energy((wedge, bolster, frame)) <= energy(old) * (1.0 + MARGIN)
    assert mechanics.kinetic_energy(after, compact(case)) == pytest.approx(energy((wedge, bolster, frame)))
    # Newton's law where an impulse acts, and no impulse where a face leaves faster than that.
    for touch, normal, place in ((touches[0], now.column, 5), (touches[1], now.bolster, 7)):
        if touch:
            assert normal >= -MARGIN
            assert after[place] + restitution * y[place] >= -MARGIN
            assert abs(normal * (after[place] + restitution * y[place])) < MARGIN


@pytest.mark.parametrize("effects", [{}, FIXTURE], ids=["rigid", "table"])
def test_closed_contacts_under_load_are_those_of_bilateral_joints(effects):
    """With N > 0 the contact problem gives what the equations of bilateral joints give."""
    generator, found = np.random.default_rng(3), 0
    bilateral = compact(record("static-dynamic", effects=effects, joints="bilateral"))[0]
    case = record("static-dynamic", effects=effects)
    s, g = case[0]["suspension"], case[0]["geometry"]
    for _ in range(200):
        wedge, bolster, table = generator.uniform((-5.0, -20.0, -20.0), (20.0, 5.0, 20.0))
        mu = generator.uniform(-0.32, 0.32, 2)
        load = Loads(wedge * g["cos_column"], wedge * g["sin_column"], bolster, 0.0, table, 0.0)
        now, _ = reactions(load, Coefficients(*mu, 0.0, 0.0), bilateral)
        frame = (table - bolster - 2.0 * wedge) / s["side_frame_mass"] if effects else 0.0
        rise = wedge / s["wedge_mass"] - frame
        free = Motion(rise * g["cos_column"], -rise * g["sin_column"], bolster / s["bolster_mass"] - frame)
        solution, count = mechanics.solve(free, Faces(True, True, True, *mu, False), compact(case))
        assert count == 1
        assert (min(now.column, now.bolster) > 0.0) == (min(solution.column, solution.bolster) > 0)
        if min(now.column, now.bolster) > 0.0:
            found += 1
            of_both = solution.reactions.column, solution.reactions.bolster
            assert of_both == pytest.approx((now.column, now.bolster), rel=1e-10)
    assert found > 30


# A guide that holds the bolster, or slips


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.tuples(*[st.floats(-30.0, 30.0)] * 3), st.tuples(st.booleans(), st.booleans()), st.booleans())
def test_a_guide_holds_the_bolster_or_rubs_with_its_whole_force(load, touches, on_table):
    """Motion and reactions fulfil the equations and inequalities of Coulomb's law on all three."""
    case = record(effects=GUIDE | (FIXTURE if on_table else {}))
    s, (t_c, n_c, t_b, p_b) = case[0]["suspension"], vectors(case[0])
    free = Motion(load[0], load[1], load[2])
    mu = 0.32
    faces = Faces(*touches, False, mu, mu, True)
    solution, certain = mechanics.solve(free, faces, compact(case))
    moved = mechanics.motion_of(solution, free, faces, compact(case))
    assert certain <= 1
    if certain == 0:  # on the verge of two states
        assert solution.margin >= -1e-9
    now = solution.reactions
    wedge, free_wedge = (each.along * t_c - each.gap * n_c for each in (moved, free))
    on_bolster = now.bolster * p_b - now.bolster_friction * t_b
    on_frame = now.column * n_c + now.column_friction * t_c
    guide = -1.5 * np.sign(moved.rise)
    if solution.guide == 0:
        assert abs(moved.rise) < 1e-12
        guide = -force_on_guide(free, on_bolster, on_frame, s, on_table)
        assert abs(guide) <= 1.5 + 1e-9
    frame = (2.0 * on_frame[1] - guide) / s["side_frame_mass"] if on_table else 0.0
    up = np.array([0.0, 1.0])
    off = s["wedge_mass"] * (wedge + frame * up - free_wedge) - on_bolster + on_frame
    assert off == pytest.approx([0.0, 0.0], abs=1e-8)
    rise = s["bolster_mass"] * (moved.rise + frame - free.rise) + 2.0 * on_bolster[1] - guide
    assert rise == pytest.approx(0.0, abs=1e-8)
    against = wedge - moved.rise * up
    for touch, normal, friction, gap, slip in (
        (touches[0], now.column, now.column_friction, -wedge @ n_c, wedge @ t_c),
        (touches[1], now.bolster, now.bolster_friction, against @ p_b, against @ t_b),
    ):
        if not touch:
            assert normal == friction == 0.0
            continue
        assert normal >= -1e-9
        assert gap >= -1e-9
        assert abs(normal * gap) < 1e-7
        assert abs(friction) <= mu * normal + 1e-9
        if abs(slip) > 1e-6 and normal > 1e-6:
            assert friction == pytest.approx(mu * normal * np.sign(slip), rel=1e-6)


def force_on_guide(free, on_bolster, on_frame, s, on_table):
    """Force (N) of the bolster on a guide that holds it."""
    # Bolster: M (frame - free) = -2 b + h; side frame, where it moves: M_sf frame = 2 c - h.
    bolster, driven = s["bolster_mass"], -2.0 * on_bolster[1]
    if not on_table:
        return driven + bolster * free.rise
    frame = (2.0 * on_frame[1] + driven + bolster * free.rise) / (s["side_frame_mass"] + bolster)
    return driven + bolster * (free.rise - frame)


@pytest.mark.acceptance
def test_a_guide_holds_the_bolster_until_the_base_shakes_it_loose_while_wedges_fly():
    """The bolster rests where its spring carries it; inertia exceeds the guide's force from 30 degrees on."""
    force, omega, samples = 0.5, 2.0 * OMEGA_N, 72
    case = record(effects={"guide_friction": {"force": force}}, wedge_spring=0.0)
    s, g = case[0]["suspension"], case[0]["geometry"]
    mass, stiffness = s["bolster_mass"], s["bolster_spring"]
    case["input"]["omega"], case["input"]["amplitude"] = omega, 2.0 * force / (mass * omega**2)
    cases, room = prepared(compact(case)), memory(1e-11, samples, 1)
    y = np.zeros(cases.scales.shape[1])
    y[0] = rest = -mass * s["gravity"] / stiffness - g["rest"]
    y[-4], y[-2] = 50.0, 20.0
    assert run_periods(cases, 0, 1, y, True, room) == 0
    moved, phase = room.x - rest, 2.0 * np.pi / samples * np.arange(samples)
    assert (moved[phase <= np.pi / 6.0 - 1e-9] == 0.0).all()
    slips = (phase > np.pi / 6.0) & (phase < 0.6 * np.pi)

    def rate(t, z):
        return z[1], (2.0 * force * np.sin(omega * t) - force - stiffness * z[0]) / mass

    span = np.pi / 6.0 / omega, np.pi / omega
    exact = solve_ivp(rate, span, (0.0, 0.0), t_eval=phase[slips] / omega, rtol=1e-11, atol=1e-14).y[0]
    assert moved[slips] == pytest.approx(exact, abs=1e-10)


@pytest.mark.acceptance
@pytest.mark.parametrize("law", ["coulomb", "static-dynamic"])
def test_a_heavy_side_frame_on_a_stiff_table_moves_as_the_base(law):
    """A light one does not, however stiff the table: an impact moves it before the table can hold it."""
    stiff = {"fixture_resonance": {"frequency": 1e3, "damping_ratio": 0.7}}
    rigid = settled(record(law, 2e-3, 1.3), 20)
    moving = settled(record(law, 2e-3, 1.3, effects=stiff, side_frame_mass=1e4), 20)
    assert rigid["impacts"] > 0.0
    for name in ("amplitude_ratio", "column_open_fraction", "bolster_open_fraction", "impact_energy"):
        assert moving[name] == pytest.approx(rigid[name], rel=2e-3), name


@pytest.mark.acceptance
@pytest.mark.parametrize(
    ("law", "effects"),
    [("coulomb", FIXTURE), ("static-dynamic", {"guide_friction": {"force": 0.3}})],
)
def test_nothing_changes_where_nothing_lifts_off(law, effects):
    for beta, amplitude in ((0.4, 1e-3), (1.4, 1e-4)):
        held, opens = (
            dict(settled(record(law, amplitude, beta, effects=effects, joints=joints), 20, 1e-11, 9))
            for joints in parameters.JOINTS
        )
        assert held["lift_off_fraction"] == opens["impacts"] == 0.0
        assert opens.pop("periodicity") == pytest.approx(held.pop("periodicity"), abs=1e-8)
        assert opens == pytest.approx(held, rel=1e-8, abs=1e-11, nan_ok=True)
