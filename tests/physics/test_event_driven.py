"""The event-driven solver: closed forms to near rounding error, and the same answers as Radau."""

from math import inf

import numpy as np
import pytest

from tests.physics import compiled_mechanics as mechanics
from tests.physics.cases import OMEGA_N
from wedgesweep import response
from wedgesweep.compiled import compiled
from wedgesweep.hybrid.state import OK
from wedgesweep.hybrid.step import MOST_STEPS, MOST_STEPS_IN_ALL, step_limit
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.event_driven import BatchSettings, empty_batch, run_batch
from wedgesweep.solvers.trajectory import CaseError, TimedWindow, Window
from wedgesweep.systems.suspension import parameters


def respond(record, settle_periods=60, periods=2, rtol=1e-9, solve=event_driven.solve):
    window = Window(float(record["input"]["omega"][0]), settle_periods, periods, 256)
    return response.evaluate(solve(record, window, rtol, inf), record, harmonics=9)


def test_a_mode_may_take_so_many_steps():
    """A stiff bristle of a mass of milligrams took 1e9 steps of 25 s, for hours."""

    @compiled
    def limit(taken, periods):
        return step_limit(taken, periods)

    assert limit(10, 1.0) == 10 + 2 * MOST_STEPS
    assert limit(10, 1e9) == 10 + MOST_STEPS_IN_ALL


def test_creep_to_a_stop_ends_where_friction_holds_the_bolster():
    """Just above breakaway only one direction slips, ever less: after k periods by 1/k^2."""
    record = parameters.record("coulomb", 7.9e-6, 2.9 * OMEGA_N)
    settings = BatchSettings(periods=1, samples_per_period=64, steady=True, tolerance=1e-9, max_periods=5000)
    batch = empty_batch(1, harmonics=1, samples=0)
    run_batch(record, np.zeros(1, np.int64), settings, 1e-9, batch)
    assert (batch.outcome[0], batch.state[0, 1], batch.period[0]) == (OK, 0.0, 1)
    assert batch.settled[0] < 300
    omega, p = 2.9 * OMEGA_N, parameters.compact(record)[0]
    most = 7.9e-6 * omega**2
    # The base acceleration is largest a quarter of a period before and after phase 0.
    margins = [
        direction
        * mechanics.breakaway(direction * np.pi / 2.0 / omega, (batch.state[0, 0], 0.0), direction, 0, p)
        for direction in (1, -1)
    ]
    assert max(margins) == pytest.approx(0.0, abs=1e-4 * most)
    assert min(margins) < -1e-2 * most


def test_slip_off_a_held_jump_is_no_event():
    """A face held at its jump slips off where velocity and rate are those of the jump, but for rounding.

    A run that took this for an event switched for ever.
    """
    record = parameters.record("static-dynamic", 4.031402889932369e-3, 0.410062893081761 * OMEGA_N)
    ratio, coarse = (respond(record, rtol=rtol).numbers["amplitude_ratio"] for rtol in (1e-10, 1e-7))
    assert ratio == pytest.approx(coarse, rel=1e-6)


AMPLITUDES = (0.026e-3, 0.03e-3, 0.033e-3, 0.0365e-3, 0.05e-3, 0.2e-3, 2e-3)


@pytest.mark.parametrize(
    ("law", "amplitude"),
    [*(("coulomb", each) for each in AMPLITUDES), ("static-dynamic", 0.2e-3), ("exponential", 0.2e-3)],
)
def test_extremes_are_those_of_the_waveforms(law, amplitude):
    """Also of slips that last a tenth of a period: their first acceleration is zero, with a sign of noise."""
    record = parameters.record(law, amplitude, 1.472 * OMEGA_N)
    found = respond(record, settle_periods=10, periods=3)
    speed = np.abs(found.waveforms["velocity"]).max()
    assert speed * (1.0 - 1e-9) <= found.numbers["peak_velocity"] <= speed * 1.005
    forces = (found.waveforms[f"normal_force_{face}"] for face in ("column", "bolster"))
    least, number = min(np.nanmin(each) for each in forces), found.numbers["minimum_normal_force"]
    assert least - 0.02 <= number <= least + 1e-9


@pytest.mark.parametrize("law", ["static-dynamic", "exponential"])
@pytest.mark.parametrize("amplitude", [0.03e-3, 0.2e-3])
def test_samples_within_steps_are_as_accurate_as_their_ends(law, amplitude):
    """A polynomial of order 4 through both ends and the middle made errors of 1e-6, at any tolerance."""
    record, window = parameters.record(law, amplitude, 0.9 * OMEGA_N), Window(0.9 * OMEGA_N, 10, 2, 100)
    found, exact = (event_driven.solve(record, window, rtol, inf).samples for rtol in (1e-9, 1e-12))
    assert np.abs(found.x - exact.x).max() < 1e-7 * np.ptp(exact.x)
    assert np.abs(found.velocity - exact.velocity).max() < 1e-7 * np.ptp(exact.velocity)


@pytest.mark.parametrize("law", ["static-dynamic", "exponential"])
def test_events_are_located_as_accurately_as_steps_are_made(law):
    """Located on steps that reach far beyond them, they made errors 5 to 15 times as large as allowed."""
    for beta in (2.19, 2.46, 2.73):
        record = parameters.record(law, 0.1e-3, beta * OMEGA_N)
        ratio, exact = (
            respond(record, settle_periods=30, periods=3, rtol=rtol).numbers["amplitude_ratio"]
            for rtol in (1e-4, 1e-9)
        )
        assert ratio == pytest.approx(exact, rel=1e-4)


def test_a_locked_wedge_is_told_as_by_radau():
    record = parameters.record(
        "coulomb",
        1e-3,
        40.0,
        suspension={"column_angle": np.radians(-4.0)},
        friction={"dynamic": 0.5},
    )
    for solve in (radau.solve, event_driven.solve):
        with pytest.raises(CaseError, match="locks") as caught:
            respond(record, solve=solve)
        assert caught.value.status == "locked"


def test_sample_times_of_ones_own_are_refused():
    window = TimedWindow(OMEGA_N, 1, 1, 0, np.array([0.0, 0.01, 0.013]))
    with pytest.raises(TypeError, match="radau"):
        event_driven.solve(parameters.record("coulomb", 1e-3, OMEGA_N), window, 1e-6, 1.0)
