"""Steady responses from neighbouring states."""

from concurrent.futures import ThreadPoolExecutor
from math import inf

import numpy as np
import pytest

from tests.physics.cases import OMEGA_N
from tests.physics.compiled_mechanics import detected_period
from tests.physics.effect_cases import REPEATING, mild
from wedgesweep import response
from wedgesweep.solvers import event_driven, periodic
from wedgesweep.solvers.period_detection import LONGEST_PERIOD
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.suspension import parameters

CASES = (("coulomb", 0.4, 1e-3), ("static-dynamic", 1.472, 1e-4), ("exponential", 0.6, 8e-4))


def records(name=None, factor=1.0, cases=CASES):
    effects = {name: mild(name)} if name else {}
    return np.concatenate(
        [parameters.record(law, factor * a, beta * OMEGA_N, effects=effects) for law, beta, a in cases]
    )


def respond(rows, warm=None, tolerance=1e-8):
    warm = warm or periodic.at_rest(len(rows))
    return periodic.respond(rows, warm, periodic.Accuracy(tolerance, 400, 1e-9), 256, 7)


@pytest.mark.few(10)
@pytest.mark.parametrize("name", [None, *REPEATING])
def test_a_warm_start_finds_what_a_cold_start_finds(name):
    # Against the end stops the exponential case answers with twice the input's period, by either solver.
    cases = {"column_compliance": CASES[1:], "end_stop": CASES[:2]}.get(name, CASES)
    first = respond(records(name, cases=cases))
    assert (first.outcome == periodic.OK).all()
    assert (first.warm.period == 1).all()
    rows = records(name, 1.01, cases)
    cold, warm = respond(rows), respond(rows, first.warm)
    size = np.abs(cold.spectra).max(axis=2)
    assert (np.abs(warm.spectra - cold.spectra).max(axis=2) < 1e-5 * size).all()
    np.testing.assert_allclose(warm.extremes, cold.extremes, rtol=1e-6)
    assert warm.periods.max() <= 12
    assert np.median(warm.periods) <= 6


@pytest.mark.parametrize("name", [None, "viscous_damping", "velocity_lag", "displacement_gain"])
def test_it_is_what_a_long_run_ends_in(name):
    rows = records(name)
    found = respond(rows)
    for i in range(len(rows)):
        row = rows[i : i + 1]
        run = event_driven.solve(row, Window(float(row["input"]["omega"][0]), 150, 1, 256), 1e-9, inf)
        expected = response.evaluate(run, row, 7)
        spectra = np.stack([expected.spectra[f"{each}_harmonics"] for each in ("displacement", "velocity")])
        complex_spectra = spectra[..., 0] + 1j * spectra[..., 1]
        size = np.abs(complex_spectra).max(axis=1, keepdims=True)
        assert (np.abs(found.spectra[i] - complex_spectra) < 1e-5 * size).all()
        assert found.stuck[i] == pytest.approx(expected.numbers["stick_fraction"], abs=1e-5)
        extremes = [run.sums[name][0] for name in ("lowest", "highest")]
        np.testing.assert_allclose(found.extremes[i], extremes, rtol=1e-5)


def test_at_a_resonance_with_hardly_any_damping_a_response_is_found_in_a_few_periods():
    """Its transient loses 1 to 6 percent per period; what has not died out must not pass as the answer."""
    rows = np.concatenate(
        [
            parameters.record(
                "coulomb",
                1e-4,
                1.14 * OMEGA_N,
                friction={"dynamic": 0.0},
                effects={"viscous_damping": {"coefficient": 120.0 * ratio}},
            )
            for ratio in (2e-3, 5e-3, 1e-2)
        ]
    )
    found = periodic.respond(rows, periodic.at_rest(3), periodic.Accuracy(1e-8, 40, 1e-9), 256, 7)
    assert (found.warm.period == 1).all()
    assert (found.periods < 20).all()
    for i in range(3):
        settled = periodic.sampled(rows[i : i + 1], np.zeros((1, 12)), 4000, 1, 256, 1e-9).x[0]
        assert 2.0 * np.abs(np.fft.rfft(settled)[1]) / 256 == pytest.approx(
            np.abs(found.spectra[i, 0, 0]), rel=1e-6
        )


@pytest.mark.parametrize("name", [None, "viscous_damping", "guide_friction"])
def test_forces_tell_for_how_long_a_normal_force_is_negative(name):
    rows = records(name, cases=(("coulomb", 2.2, 0.3e-3), ("static-dynamic", 2.2, 3e-3)))
    found = periodic.respond(
        rows, periodic.at_rest(2), periodic.Accuracy(1e-8, 400, 1e-9), 256, 7, forces=True
    )
    assert found.lifted[0] == 0.0 < found.lifted[1]
    for i in range(2):
        run = event_driven.solve(
            rows[i : i + 1], Window(float(rows["input"]["omega"][i]), 150, 1, 256), 1e-9, 60.0
        )
        share = run.sums["lifted_time"][0] / run.sums["time"][0]
        assert found.lifted[i] == pytest.approx(share, abs=1e-4)
    silent = respond(rows)
    assert np.isnan(silent.lifted).all()
    np.testing.assert_array_equal(silent.spectra, found.spectra)


def test_a_neighbour_that_is_already_steady_costs_one_period():
    rows = records()
    first = respond(rows)
    again = respond(rows, first.warm, tolerance=1e-7)
    assert (again.periods == 1).all()
    np.testing.assert_allclose(again.spectra, first.spectra, rtol=1e-4, atol=1e-9)


@pytest.mark.parametrize("factor", [0.99, 0.998, 1.0, 1.0005, 1.0009, 1.0012])
def test_a_small_step_of_a_parameter_takes_few_periods(factor):
    # Close to a response whose derivative of the map is known: one or two of Newton's steps.
    case = CASES[1:2]
    first = respond(records(factor=1.001, cases=case), tolerance=1e-6)
    assert np.isfinite(first.warm.map[0, :2, :2]).all()
    assert respond(records(factor=factor, cases=case), first.warm, tolerance=1e-6).periods[0] <= 3


def distorted(amplitude, share=1.0):
    """Cases that repeat after two periods from rest, if their input is distorted this much."""
    tones = {"second": 3.07e-4 * share, "second_phase": -1.86, "third": 5.56e-4 * share, "third_phase": 2.8}
    return parameters.record(
        "static-dynamic", amplitude, 2.0 * np.pi * 5.181, effects={"input_distortion": tones}
    )


def halves(row, state, periods=100):
    """How far the two halves (m) of two periods are apart, a hundred periods after a state."""
    x = periodic.sampled(row, state, periods, 2, 256, 1e-9).x
    return np.abs(x[0, :256] - x[0, 256:]).max()


def test_a_response_of_two_periods_leads_to_its_neighbour():
    first = respond(distorted(2.85e-3))
    row = distorted(2.855e-3)
    cold, warm = respond(row), respond(row, first.warm)
    assert (first.warm.period[0], cold.warm.period[0], warm.warm.period[0]) == (2, 2, 2)
    np.testing.assert_allclose(warm.spectra, cold.spectra, atol=1e-7 * np.abs(cold.spectra).max())
    assert warm.periods[0] < cold.periods[0]
    # From where it is steady: two periods that come back, and one that does not.
    assert respond(distorted(2.85e-3), first.warm).periods[0] == 3


def test_a_case_with_two_responses_keeps_to_that_of_its_neighbour():
    row = distorted(2.89e-3)
    cold = respond(row)
    warm = respond(row, respond(distorted(2.89e-3, 0.9)).warm)
    assert (cold.warm.period[0], warm.warm.period[0]) == (2, 1)
    # Both are stable.
    assert halves(row, cold.warm.state) > 5e-6
    assert halves(row, warm.warm.state) < 1e-9


def test_faces_that_age_do_not_keep_a_case_from_being_steady():
    ageing = {"ageing": {"rate": 0.05, "time": 0.01}}
    found = respond(parameters.record("coulomb", 1e-6, 0.6 * OMEGA_N, effects=ageing))
    assert (found.warm.period[0], found.stuck[0]) == (1, 1.0)
    assert found.periods[0] <= 3
    # Where they creep, the response does not depend on where it started.
    row = parameters.record("static-dynamic", 5e-6, 0.6 * OMEGA_N, effects=ageing)
    # The seventh harmonic is a millionth of the motion.
    found = respond(row, tolerance=1e-12)
    again = respond(row, found.warm, tolerance=1e-12)
    assert (found.warm.period[0], again.warm.period[0], found.stuck[0]) == (1, 1, 1.0)
    np.testing.assert_allclose(again.spectra, found.spectra, rtol=1e-6)
    assert found.periods[0] < 40


def test_threads_do_not_disturb_each_other():
    rows = np.concatenate([records(), records("viscous_damping")])
    alone = respond(rows)
    with ThreadPoolExecutor(2) as pool:
        both = list(pool.map(respond, [rows, rows]))
    for found in both:
        np.testing.assert_array_equal(found.spectra, alone.spectra)


def test_a_locked_wedge_has_no_response():
    rows = parameters.record(
        "coulomb", 1e-3, 40.0, suspension={"column_angle": np.radians(-4.0)}, friction={"dynamic": 0.5}
    )
    found = respond(rows)
    assert found.outcome[0] != periodic.OK
    assert np.isnan(found.spectra).all()
    assert np.isnan(found.warm.state).all()


def test_sensors_turn_and_scale_the_spectra():
    plain = respond(records())
    lag, gain = 2e-3, 1.1
    rows = records()
    rows["velocity_lag"]["time"], rows["displacement_gain"]["scale"] = lag, gain
    seen = respond(rows)
    np.testing.assert_allclose(seen.spectra[:, 0], gain * plain.spectra[:, 0], rtol=1e-12)
    turns = 1j * np.outer(rows["input"]["omega"], np.arange(1, 8)) * lag
    np.testing.assert_allclose(seen.spectra[:, 1], plain.spectra[:, 1] / (1 + turns), rtol=1e-12)


def test_the_lagged_waveform_has_the_lagged_spectrum():
    row = parameters.record("exponential", 8e-4, 0.6 * OMEGA_N, effects={"velocity_lag": {"time": 5e-3}})
    run = event_driven.solve(row, Window(float(row["input"]["omega"][0]), 60, 2, 256), 1e-9, inf)
    seen = response.evaluate(run, row, 7)
    velocity = seen.waveforms["velocity"][:256]
    spectrum = np.fft.rfft(velocity)[1:8] / 128
    expected = seen.spectra["velocity_harmonics"] @ [1.0, 1j]
    np.testing.assert_allclose(spectrum, expected, atol=2e-5 * np.abs(spectrum).max())
    assert seen.numbers["peak_velocity"] == np.abs(seen.waveforms["velocity"]).max()


TOLERANCE = 1e-6


def back(states):
    """Distances of the last state (complex) from those before it."""
    found = np.full(LONGEST_PERIOD, np.inf)
    before = np.abs(states[-1] - states[-2 : -2 - LONGEST_PERIOD : -1])
    found[: before.size] = before
    return found


@pytest.mark.parametrize("n", [1, 2, 3, 8])
@pytest.mark.parametrize("size", [1.0, 2e-3])
def test_a_cycle_has_its_length(n, size):
    cycle = size * np.exp(2j * np.pi * np.arange(30) / n)
    assert detected_period(back(cycle), TOLERANCE) == n


def test_a_spiral_that_closes_slowly_is_no_cycle():
    for turns in (2, 3, 5):
        spiral = (0.99 * np.exp(2j * np.pi / turns)) ** np.arange(3000)
        for end in range(10, 3000):
            assert detected_period(back(spiral[:end]), TOLERANCE) <= 1


def test_a_state_that_wanders_does_not_repeat():
    states = np.random.default_rng(0).normal(size=(50, 2)) @ [1.0, 1j]
    assert detected_period(back(states), TOLERANCE) == 0


def test_the_mean_over_a_doubled_period_does_not_depend_on_the_tolerance():
    """A response whose two halves differ by 0.1 to 1 % of the input."""
    row = parameters.record("static-dynamic", 3.4e-3, 0.36 * OMEGA_N)
    nothing = periodic.at_rest(1)
    coarse, fine = (
        periodic.respond(row, nothing, periodic.Accuracy(tol, 60, tol), 256, 16) for tol in (1e-6, 1e-9)
    )
    assert (coarse.warm.period[0], fine.warm.period[0]) == (2, 2)
    np.testing.assert_allclose(coarse.spectra, fine.spectra, atol=1e-5 * np.abs(fine.spectra).max())
    assert coarse.stuck[0] == pytest.approx(fine.stuck[0], abs=1e-5)


def test_faces_that_do_not_slip_in_every_period_are_not_taken_to_rest_for_ever():
    """Under ageing both are responses: fully aged faces hold, those that slip before that do not."""
    ageing = {"ageing": {"rate": 0.0211, "time": 2.27e-3}}
    leaning = {"column_angle": np.radians(-4.0)}
    row = parameters.record("exponential", 0.467e-3, 2.0 * np.pi * 7.661, leaning, effects=ageing)
    nothing = periodic.at_rest(1)
    found = periodic.respond(row, nothing, periodic.Accuracy(TOLERANCE, 200, TOLERANCE), 256, 8)
    periods = int(found.warm.period[0])
    assert periods == 2
    x = periodic.sampled(row, nothing.state, 200, periods, 256, TOLERANCE).x
    fourier = -2.0 * np.fft.rfft(x[0])[periods : 9 * periods : periods] / x.size  # displacement is -x
    np.testing.assert_allclose(found.spectra[0, 0], fourier, atol=1e-3 * np.abs(fourier).max())
