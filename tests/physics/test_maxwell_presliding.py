"""Springs with sliders in parallel: Masing's rules, work of a cycle and limits in closed form."""

from math import inf

import numpy as np
import pytest

from tests.physics.test_oscillator import AMPLITUDE, OMEGA_N, SOLVERS, K, coulomb, oscillator, steady
from wedgesweep.compiled import compiled
from wedgesweep.effects import maxwell_presliding
from wedgesweep.hybrid.vectors import replaced
from wedgesweep.solvers import event_driven, imposed_motion
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.oscillator import parameters

# Force (N), stiffness after a reversal (N/m) and spreads.
FORCE, STIFFNESS = 50.0, 2e5
SPREADS = (0.0, 1.0, 2.5)
NUMBERS = ("force", "stiffness", "spread", *maxwell_presliding.DERIVED)
# A record of the effect alone, which takes a second to compile.
ALONE = np.dtype([("maxwell_presliding", [(name, np.float64) for name in NUMBERS])])
# Displacement (m) at which the last of all elements slips.
LONGEST = 0.02


def alone(spread, stiffness=STIFFNESS):
    record = np.zeros(1, ALONE)
    for name, value in zip(NUMBERS, (FORCE, stiffness, spread), strict=False):
        record[0]["maxwell_presliding"][name] = value
    maxwell_presliding.prepare(record[0])
    return record


@compiled
def along(record, displacement, out):
    """Write the force (n,) against a displacement (n,) that begins at rest."""
    p, y = record[0], (0.0,) * 7
    for i in range(displacement.size):
        y = replaced(y, 1, displacement[i] - (displacement[i - 1] if i else 0.0))
        y = maxwell_presliding.moved(y, y, 1.0, p)
        out[i] = -maxwell_presliding.force_on_mass(0.0, 0.0, y, p)


def force(displacement, spread, stiffness=STIFFNESS):
    out = np.empty(len(displacement))
    along(alone(spread, stiffness), np.asarray(displacement, float), out)
    return out


def elongations(spread):
    """Elongation (5,) at which each element slips, from what the effect states."""
    relative = np.exp(0.4 * spread * np.arange(-2, 3))
    return relative * FORCE / STIFFNESS * np.mean(1.0 / relative)


def backbone(displacement, spread):
    """Force of a first loading: each spring pulls up to a fifth of the force."""
    shares = np.asarray(displacement)[:, None] / elongations(spread)
    return FORCE * np.minimum(shares, 1.0).mean(axis=1)


@pytest.mark.parametrize("spread", SPREADS)
def test_the_first_loading_begins_with_the_stiffness_and_ends_with_the_force(spread):
    displacement = np.linspace(0.0, LONGEST, 400)
    found = force(displacement, spread)
    assert found == pytest.approx(backbone(displacement, spread), rel=1e-12, abs=1e-9)
    assert found[-1] == pytest.approx(FORCE, rel=1e-12)
    assert force([1e-7], spread) == pytest.approx(STIFFNESS * 1e-7, rel=1e-12)
    slope = np.diff(found)
    assert (slope >= -1e-12).all()
    assert (np.diff(slope) <= 1e-9).all()


@pytest.mark.parametrize("spread", SPREADS)
def test_masings_rules_hold(spread):
    """A branch is the first loading twice as large; an inner loop closes, and the outer branch goes on."""
    turn = 0.6 * elongations(spread)[-1]
    path = np.r_[np.linspace(0.0, turn, 100), np.linspace(turn, -turn, 200), np.linspace(-turn, turn, 200)]
    found = force(path, spread)
    down = found[100:300]
    expected = found[99] - 2.0 * backbone(0.5 * (turn - path[100:300]), spread)
    assert down == pytest.approx(expected, abs=1e-9 * FORCE)
    # The third branch comes back to where the first one turned, as if a small loop had not been.
    assert found[-1] == pytest.approx(found[99], abs=1e-9 * FORCE)
    inner = np.r_[path[:400], path[399] - np.linspace(0.0, 0.2 * turn, 50)]
    inner = np.r_[inner, np.linspace(inner[-1], path[399], 50), path[400:]]
    assert force(inner, spread)[-100:] == pytest.approx(found[-100:], abs=1e-9 * FORCE)


@pytest.mark.parametrize("spread", SPREADS)
@pytest.mark.parametrize("share", [0.3, 1.5, 20.0])
def test_a_cycle_takes_the_work_of_the_sliders(spread, share):
    """Each slider moves four times as far as the amplitude exceeds its spring's elongation."""
    amplitude = share * FORCE / STIFFNESS
    cycle = amplitude * np.r_[np.linspace(0, 1, 500), np.linspace(1, -1, 1000), np.linspace(-1, 1, 1000)]
    found = force(cycle, spread)
    last = slice(499, None)
    work = np.trapezoid(found[last], cycle[last])
    slid = np.maximum(amplitude - elongations(spread), 0.0).mean()
    assert work == pytest.approx(4.0 * FORCE * slid, rel=1e-4, abs=1e-9)


def test_a_stiff_one_is_coulombs_friction_and_one_without_spread_jenkins_element():
    path = 1e-3 * np.sin(np.linspace(0.0, 12.0, 500))
    sign = np.sign(np.diff(path))
    assert force(path, 2.0, 1e12)[1:] == pytest.approx(FORCE * sign, rel=1e-9)
    held = 0.0
    for now, before, found in zip(path[1:], path, force(path, 0.0)[1:], strict=False):
        held = min(max(held + STIFFNESS * (now - before), -FORCE), FORCE)
        assert found == pytest.approx(held, abs=1e-9 * FORCE)


def case(law="coulomb", omega=0.8 * OMEGA_N, level=0.0, **changed):
    effects = {"maxwell_presliding": {"force": 0.5, "stiffness": 5e3, "spread": 1.0} | changed}
    numbers = oscillator(damping=6.0, contact="base")
    return parameters.record(law, AMPLITUDE, omega, numbers, coulomb(level), effects)


@pytest.mark.acceptance
@pytest.mark.parametrize("level", [0.0, 0.3])
def test_both_solvers_run_it_and_balance_its_energy(level):
    found = [steady(case(level=level), each, rtol=1e-8, settle=15).numbers for each in SOLVERS]
    for number in ("amplitude_ratio", "dissipated_energy"):
        assert found[0][number] == pytest.approx(found[1][number], rel=1e-5), number
    for each in found:
        assert each["supplied_energy"] == pytest.approx(each["dissipated_energy"], rel=2e-5)


@pytest.mark.acceptance
def test_a_mass_held_by_elements_that_do_not_slip_swings_on_their_springs():
    record = parameters.record(
        "coulomb",
        1e-12,
        OMEGA_N,
        oscillator(),
        coulomb(0.0),
        {"maxwell_presliding": {"force": 1e3, "stiffness": K, "spread": 1.0}},
        "force",
    )
    run = event_driven.solve(record, Window(OMEGA_N, 0, 1, 256), 1e-10, inf, start=(1e-3, 0.0))
    samples = run.samples
    expected = 1e-3 * 0.5 * (1.0 + np.cos(np.sqrt(2.0) * OMEGA_N * (samples.t - samples.t[0])))
    assert -samples.x == pytest.approx(expected, abs=1e-9)


@pytest.mark.acceptance
@pytest.mark.parametrize("law", ["coulomb", "exponential"])
@pytest.mark.parametrize("solver", SOLVERS)
def test_two_half_swings_lose_the_work_of_a_first_loading_and_of_a_branch(solver, law):
    """From A to -B the force is that of a first loading, back to C that of a branch by Masing's rules."""
    start, stiffness, spread = 2e-3, 4.0 * K, 1.0
    effect = {"force": 0.25 * K * start, "stiffness": stiffness, "spread": spread}
    numbers = oscillator(normal_force=0.0)
    record = parameters.record(
        law, 1e-12, OMEGA_N, numbers, coulomb(0.3), {"maxwell_presliding": effect}, "force"
    )
    window = Window(OMEGA_N, 0, 2, 8192)
    motion = -SOLVERS[solver].solve(record, window, 1e-10, inf, start=(start, 0.0)).samples.x
    down = motion.argmin()
    up = down + motion[down : down + 6000].argmax()
    way = np.linspace(0.0, 2.0 * start, 40001)
    scale = effect["force"] / FORCE * STIFFNESS / stiffness
    first = effect["force"] / FORCE * backbone(way / scale, spread)
    branch = 2.0 * effect["force"] / FORCE * backbone(0.5 * way / scale, spread)

    def lost(travel, taken):
        return np.trapezoid(taken[way <= travel], way[way <= travel])

    low, high = -motion[down], motion[up]
    assert first[way <= start + low][-1] == pytest.approx(effect["force"])  # all elements slip
    energy = 0.5 * K * np.array([start**2 - low**2, low**2 - high**2])
    taken = [lost(start + low, first), lost(low + high, branch - effect["force"])]
    assert energy == pytest.approx(taken, rel=1e-3)


@pytest.mark.acceptance
@pytest.mark.parametrize("spread", SPREADS)
def test_an_imposed_motion_takes_the_same_force(spread):
    """Means over samples near reversals aside, and from the end of the first half cycle on."""
    numbers = {"mass": 1e-9, "spring": 0.0, "damping": 0.0, "normal_force": 0.0}
    effects = {"maxwell_presliding": {"force": FORCE, "stiffness": STIFFNESS, "spread": spread}}
    record = parameters.record("coulomb", 0.0, 1.0, numbers, coulomb(0.3), effects)
    angle, step = 2.0 * np.pi * np.arange(6000) / 2000.0, 1.0 / 2000.0
    place = LONGEST * np.sin(angle)
    speed, gain = 2.0 * np.pi * LONGEST * np.cos(angle), -4.0 * np.pi**2 * place
    found = imposed_motion.forces(record, place, speed, gain, step)[0]
    expected = force(np.r_[place], spread)
    assert found[1000:] == pytest.approx(expected[1000:], abs=2e-2 * FORCE)
    assert np.abs(found[1000:] - expected[1000:]).mean() < 1e-3 * FORCE
