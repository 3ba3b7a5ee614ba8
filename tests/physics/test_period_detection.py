"""When a state counts as one that came back."""

import numpy as np
import pytest

from tests.physics.cases import OMEGA_N
from tests.physics.compiled_mechanics import detected_period
from wedgesweep.solvers import periodic
from wedgesweep.solvers.period_detection import LONGEST_PERIOD
from wedgesweep.systems.suspension import parameters

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
