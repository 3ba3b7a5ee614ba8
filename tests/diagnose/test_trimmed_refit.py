"""Fits that a single test holds up, on systems of the validation campaign."""

import numpy as np
import pytest

from tests.diagnose.synthetic import LAG, MODEL, base_of, drawn, next_to_breakaway, searched
from wedgesweep.diagnose import jacobian, trimmed_refit
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.search import Search


def refined(data, effects, x):
    """Fit of effects from their numbers (k,) on, beside the base model's fit."""
    model, base = Search.of(data, effects).model(*effects), base_of(data) if effects else None
    return minimise(model, model.evaluate(model.start(base, np.asarray(x, float))))


def test_around_a_test_next_to_breakaway(monkeypatch):
    with monkeypatch.context() as differences:
        # Steps that are too long for so steep a misfit.
        differences.setattr(jacobian, "LARGEST_CHANGE", np.inf)
        held_up = refined(next_to_breakaway(), ("stribeck", "viscous_damping"), (6e-3, -0.6, 0.0))
    assert held_up.p < 1e-9
    found = trimmed_refit.refit_without_influential_tests(held_up)
    assert found.p > 0.01
    assert found.x[2] == pytest.approx(2.4, rel=0.05)


def test_around_a_test_that_has_two_responses():
    """The second one repeats after two periods from rest, and after one from where the base model leads."""
    hertz = np.array([5.181, 5.181, 8.196, 10.615, 19.306, 28.203])
    amplitude = 1e-3 * np.array([0.77024, 2.89193, 0.78434, 0.22942, 0.10986, 0.04951])
    tones = {"second": 3.07453e-4, "second_phase": -1.8564, "third": 5.56403e-4, "third_phase": 2.79555}
    data = drawn({"input_distortion": tones}, bench=(hertz, amplitude), std=0.007, level=0.01)
    held_up = refined(data, ("input_distortion",), np.full(4, 1e-4))
    assert (held_up.evaluation.point.warm.period == 1).all()
    assert held_up.p < 1e-9
    found = trimmed_refit.refit_without_influential_tests(held_up)
    np.testing.assert_array_equal(found.evaluation.point.warm.period, [1, 2, 1, 1, 1, 1])
    assert found.p > 0.01
    fitted = found.model.values(found.x)["input_distortion"]
    assert {name: fitted[name] for name in tones} == pytest.approx(tones, rel=0.05)


def test_around_a_test_that_sticks():
    """A bolster 7 % heavier moves at 19.6 Hz only with what the other tests say of the stops."""
    hertz = np.array([5.05, 5.05, 7.76, 7.76, 10.64, 19.55, 19.55, 24.03, 28.0, 30.48])
    amplitude = 1e-3 * np.array([0.7365, 2.801, 0.3358, 0.987, 0.25, 0.0444, 0.1188, 0.1382, 0.05, 0.0698])
    data = drawn(
        {"bolster_mass": {"scale": 1.0746}, "end_stop": {"clearance": 0.42835e-3, "stiffness": 122.7e3}},
        bench=(hertz, amplitude),
        std=0.0103,
        law="coulomb",
        model=MODEL + "[suspension]\ncolumn_angle_deg = 4.0\n",
    )
    held_up = refined(data, ("end_stop", "bolster_mass"), (np.log(0.4322), np.log(150.6), 1.07))
    assert held_up.model.data.insensitive(held_up.evaluation).tolist() == [place == 5 for place in range(10)]
    assert held_up.p < 1e-9
    found = trimmed_refit.refit_without_influential_tests(held_up)
    assert found.p > 0.01
    assert found.values["bolster_mass"]["scale"] == pytest.approx(1.0746, abs=0.002)


@pytest.mark.parametrize(("true", "off"), [(0.25, -0.07), (0.255, -0.04)])
def test_around_a_test_whose_input_led_to_where_it_sticks(true, off):
    """From an input that was stated too high a step down ends short of breakaway, where nothing leads on."""
    data = drawn(
        off=np.array([0.0, off, 0.0, 0.0]),
        bench=(
            np.array([5.169, 7.744, 11.184, 19.924]),
            1e-3 * np.array([0.6431, true / (1.0 + off), 0.2129, 0.04879]),
        ),
        std=0.0153,
        law="coulomb",
        model=MODEL + "[suspension]\ncolumn_angle_deg = 4.0\n",
    )
    held_up = refined(data, (), ())
    assert held_up.model.data.insensitive(held_up.evaluation).tolist() == [False, True, False, False]
    found = trimmed_refit.refit_without_influential_tests(held_up)
    assert found.p > 0.01
    assert found.model.data.amplitudes(found.point)[1] == pytest.approx(1e-3 * true, rel=0.002)


def test_what_nothing_holds_up_stays():
    _, _, (lag,) = searched(drawn(LAG), "velocity_lag")
    assert trimmed_refit.refit_without_influential_tests(lag.fit) is lag.fit
