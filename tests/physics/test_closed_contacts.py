"""Unilateral joints whose contacts are closed: they are bilateral ones, and never beyond an opening."""

from math import inf

import numpy as np
import pytest

from tests.physics import compiled_unilateral as mechanics
from tests.physics.cases import OMEGA_N
from wedgesweep import excitation
from wedgesweep.friction import LAW_NAMES
from wedgesweep.hybrid.state import CHATTERING, LOCKED, OK
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.period_map import memory, prepared, run_periods
from wedgesweep.solvers.periodic import sampled
from wedgesweep.solvers.trajectory import CaseError, Window
from wedgesweep.systems import compact, example, opens
from wedgesweep.systems.suspension import parameters

RTOL, PERIODS = 1e-9, 3
EFFECTS = {"viscous_damping": {"coefficient": 8.0}, "stribeck": {"velocity": 5e-3, "peak": 0.05}}
STOP = {"end_stop": {"clearance": 2e-4, "stiffness": 2e4}, "input_distortion": {"second": 0.1}}


def random_case(generator, law, largest=4e-3, effects=None, locks=False):
    """The same random case with both kinds of joints; ``locks``: whether a state of it could lock."""
    while True:
        suspension = {
            "wedge_mass": generator.uniform(0.02, 0.4),
            "bolster_mass": generator.uniform(0.4, 1.5),
            "wedge_preload": generator.uniform(0.0, 8.0),
            "column_angle": generator.choice((-0.07, 0.03, 0.07, 0.15)),
            "wedge_spring": generator.uniform(500.0, 4000.0),
            # From a stream of its own: the other numbers stay as they were.
            "damping": generator.spawn(1)[0].choice(parameters.DAMPING),
        }
        mu = generator.uniform(0.3, 0.6) if locks else generator.uniform(0.05, 0.3)
        friction = {"dynamic": mu, "static": mu * generator.uniform(1.0, 1.2)}
        amplitude = np.exp(generator.uniform(np.log(1e-5), np.log(largest)))
        omega = OMEGA_N * generator.uniform(0.2, 3.0)
        both = [
            parameters.record(law, amplitude, omega, suspension | more, friction, effects or {})
            for more in ({}, {"joints": "unilateral", "restitution": generator.choice((0.0, 0.4))})
        ]
        if bool(both[1]["geometry"]["always_well_posed"][0]) != locks:
            return both


def run(case, shared=True, start=(), periods=PERIODS, rtol=RTOL):
    """Outcome, state and sums of some periods, from rest; ``shared``: with methods of bilateral joints."""
    if not shared:
        case = case.copy()
        case["geometry"]["opens"] = 0
    cases, room = prepared(compact(case)), memory(rtol, 32, periods)
    y = np.zeros(cases.scales.shape[1])
    y[: len(start)] = start
    return run_periods(cases, 0, periods, y, True, room), y, room


@pytest.mark.few(1)
@pytest.mark.parametrize("law", LAW_NAMES)
def test_contacts_about_to_open_are_never_followed_as_bilateral(law):
    """Of random states, those that bilateral joints would follow have one mode, and it is theirs."""
    generator, followed, opens = np.random.default_rng(1), 0, 0
    for _ in range(40):
        opening = compact(random_case(generator, law)[1])
        p = opening[0]
        reach = 3.0 * 9.80665 * p["suspension"]["bolster_mass"] / p["suspension"]["bolster_spring"]
        for i in range(250):
            speed = 0.0 if i % 5 == 0 else generator.normal() * 10.0 ** generator.uniform(-5.0, 0.0)
            t, y = generator.uniform(0.0, 0.1), (generator.normal() * reach, speed)
            taken, mode = mechanics.bilateral_mode(t, y, opening)
            true, certain = mechanics.contacts_at(t, y, opening)
            assert certain
            opens += min(true.column_sign, true.bolster_sign) == 0
            if taken:
                followed += 1
                assert (true.column_sign, true.bolster_sign) == (1, 1)
                assert (mode.column, mode.bolster, mode.segment) == (true.column, true.bolster, true.segment)
            elif y[1] != 0.0:
                assert min(true.column_sign, true.bolster_sign) == 0
    assert min(followed, opens) > 1000


def test_a_bolster_at_rest_between_loaded_faces_holds_whatever_the_input():
    """Where both faces carry load on the verge of slip to either side, they hold at all inputs between."""
    generator, known = np.random.default_rng(2), 0
    for _ in range(60):
        opening = compact(random_case(generator, "coulomb")[1])
        omega = opening["input"]["omega"][0]
        for _ in range(20):
            y = (generator.normal() * 3e-3, 0.0)
            up, down = mechanics.breakaway_inputs(y, opening)
            if not up < down:
                continue
            known += 1
            for share in (1e-6, *generator.uniform(0.0, 1.0, 5), 1.0 - 1e-6):
                base = up + share * (down - up)
                opening["input"]["amplitude"] = abs(base) / omega**2
                quarter = 3.0 if base > 0.0 else 1.0
                mode, certain = mechanics.contacts_at(0.5 * np.pi * quarter / omega, y, opening)
                assert certain
                assert (mode.column_sign, mode.bolster_sign, mode.column, mode.bolster) == (1, 1, 0, 0)
    assert known > 100


def open_time(room):
    return room.sums["either_open"][0]


def assert_same(room, its, y, start):
    """What bilateral joints do, to rounding: time of an event is known to 1e-10 of a period, or better."""
    assert y[:2] == pytest.approx(start, rel=1e-7, abs=1e-9 * np.abs(its.x).max())
    assert not y[2:].any()
    for name in ("x", "velocity"):
        mine, other = getattr(room, name), getattr(its, name)
        assert mine == pytest.approx(other, rel=1e-7, abs=1e-8 * np.abs(other).max()), name
    assert (room.sticks != its.sticks).sum() <= 1
    for name in room.sums.dtype.names:
        # The ends of a force are read off at the quadrature nodes, which one step more may move.
        close = 1e-5 if name.endswith(("_least", "_most")) else 1e-6
        assert room.sums[name] == pytest.approx(its.sums[name], rel=close, abs=1e-12), name


KINDS = {"plain": {}, "effects": EFFECTS, "stop": STOP, "series": {}}


@pytest.mark.few(1)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("law", LAW_NAMES)
def test_random_cases_are_bilateral_until_a_contact_opens_and_themselves_after_that(law, kind):
    """Where nothing opens to rounding; elsewhere what the equations for all motions do alone."""
    generator, closed, opened = np.random.default_rng(3), 0, 0
    for _ in range(150 if kind == "plain" else 24):
        bilateral, unilateral = random_case(generator, law, 4e-3 if kind == "plain" else 2e-3, KINDS[kind])
        if kind == "series":
            for case in (bilateral, unilateral):
                excitation.set_series(case, np.array([-1j, 0.2 + 0.1j]))
        outcome, y, room = run(unilateral)
        alone_outcome, _, other = run(unilateral, shared=False)
        assert outcome == alone_outcome == 0
        if open_time(room) == open_time(other) == 0.0:
            closed += 1
            _, held, its = run(bilateral)
            assert its.sums["lifted_time"][0] == 0.0
            assert_same(room, its, y, held[:2])
            continue
        opened += 1
        size = [np.abs(each).max() for each in (other.x, other.velocity)]
        assert room.x == pytest.approx(other.x, abs=1e-6 * size[0])
        assert room.velocity == pytest.approx(other.velocity, abs=1e-5 * size[1])
        assert open_time(room) == pytest.approx(open_time(other), abs=1e-6 * room.sums["time"][0])
        assert room.sums["impacts"] == other.sums["impacts"]
    assert min(closed, opened) > (30 if kind == "plain" else 3)


@pytest.mark.few(1)
@pytest.mark.parametrize("law", LAW_NAMES)
def test_cases_that_could_lock_are_followed_alike_and_lock_alike(law):
    generator, followed, opened = np.random.default_rng(5), 0, 0
    for _ in range(150):
        _, case = random_case(generator, law, 3e-3, locks=True)
        outcome, _, room = run(case)
        alone_outcome, _, other = run(case, shared=False)
        if CHATTERING in (outcome, alone_outcome):  # bounces: their number is limited
            continue
        assert outcome == alone_outcome
        if outcome != OK:
            assert outcome == LOCKED
            continue
        followed += open_time(other) == 0.0
        opened += open_time(other) > 0.0
        assert room.x == pytest.approx(other.x, abs=1e-6 * np.abs(other.x).max())
        assert room.sums["impacts"] == other.sums["impacts"]
    assert min(followed, opened) > 25


@pytest.mark.parametrize("rtol", [1e-5, 1e-9])
def test_a_pole_of_the_normal_forces_is_not_taken_for_lift_off(rtol):
    """Where the determinant of two faces that slip passes zero forces change their sign through infinity."""
    friction = {"dynamic": 0.46727362165893815, "static": 0.5373646649077789}
    suspension = {"column_angle": -0.07, "wedge_mass": 0.17, "joints": "unilateral"}
    case = parameters.record("static-dynamic", 3.73190765e-4, 205.35574258, suspension, friction)
    with pytest.raises(CaseError) as raised:
        event_driven.solve(case, Window(205.35574258, 2, 2, 64), rtol=rtol, time_limit=inf)
    assert raised.value.status == "locked"


@pytest.mark.acceptance
@pytest.mark.parametrize("law", LAW_NAMES)
def test_radau_shares_them_as_well(law):
    window = Window(1.472 * OMEGA_N, 1, 2, 32)
    held, closed, opens = (
        radau.solve(
            parameters.record(law, amplitude, 1.472 * OMEGA_N, {"joints": joints}),
            window,
            rtol=1e-8,
            time_limit=inf,
        )
        for amplitude, joints in ((1e-4, "bilateral"), (1e-4, "unilateral"), (3e-4, "unilateral"))
    )
    assert closed.samples.x == pytest.approx(held.samples.x, abs=1e-6 * np.abs(held.samples.x).max())
    assert closed.sums["either_open"][0] == 0.0
    assert opens.sums["either_open"][0] > 0.0
    outcome, _, room = run(parameters.record(law, 3e-4, 1.472 * OMEGA_N, {"joints": "unilateral"}), periods=3)
    assert outcome == 0
    assert opens.samples.x == pytest.approx(room.x[32:], abs=1e-6 * np.abs(room.x).max())


def test_a_run_may_begin_and_end_with_an_open_contact():
    """Samples, and a run in two parts, of a motion in which contacts open and close."""
    case = parameters.record("coulomb", 1e-3, 1.2 * OMEGA_N, {"joints": "unilateral"})
    _, last, whole = run(case, periods=4)
    parts = [run(case, periods=2)]
    parts.append(run(case, start=parts[0][1], periods=2))
    assert parts[0][1][2:].any()
    assert 0.0 < open_time(whole) < whole.sums["time"][0]
    assert np.concatenate([room.x for _, _, room in parts]) == pytest.approx(whole.x, abs=1e-10)
    found = sampled(case, np.zeros((1, last.size)), 1, 3, 32, RTOL)
    assert found.x[0] == pytest.approx(whole.x[32:], abs=1e-10)
    assert found.state[0, : last.size] == pytest.approx(last, abs=1e-7)


@pytest.mark.parametrize("kit", range(5))
def test_an_example_of_a_kit_for_contacts_that_open_has_such_contacts(kit):
    """Or code for open contacts would be compiled in the middle of the first case."""
    case = example("suspension", 2 * kit)
    assert opens(case)[0] == (kit in parameters.OPENING)
