"""Fits of transients whose response jumps: a mass that just stops at a turn, or just does not."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.test_transients import OSCILLATOR, write
from wedgesweep.diagnose.least_squares import from_other_nuisances, minimise
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.transient.beyond_jumps import best_start, places, standing_out
from wedgesweep.diagnose.transient.from_measurement import transient_data
from wedgesweep.measured import read

STOPS = OSCILLATOR.replace("static = 0.3", "static = 0.36").replace('"coulomb"', '"static-dynamic"')
STOPS = STOPS.replace("damping_N_s_per_m = 1.0\n", "")
# Displacements (m) of a second release at -0.05 m/s that just passes a turn; from 0.1 mm less it stops there.
JUST_PASSES = (4.405e-3, 5.873e-3)
LOWER = np.array([[0.0, 0.0], [-0.1e-3, 0.0], [0.0, 0.0]])


def starting_at(model, starts):
    """The point at which the tests start from displacements and velocities (T, 2) over the data's scale."""
    point = model.start(None, np.zeros(0))
    return replace(point, nuisance=np.column_stack([starts, point.nuisance[:, 2:]]))


@pytest.mark.acceptance
@pytest.mark.parametrize("displacement", JUST_PASSES)
def test_a_fit_gets_over_a_stop(tmp_path, displacement):
    starts = ((0.0102, 0.0), (displacement, -0.05), (-0.0091, 0.02))
    data = transient_data(read(write(tmp_path, STOPS, starts=starts)))
    model = Search.of(data, []).model()
    right = minimise(model, model.evaluate(starting_at(model, np.array(starts) / data._scale)))
    assert right.p > 1e-3
    lower = right.point.nuisance[:, :2] + LOWER / data._scale
    stuck = minimise(model, model.evaluate(starting_at(model, lower)))
    assert stuck.chi2 > 5.0 * right.chi2
    assert from_other_nuisances(stuck).chi2 == pytest.approx(right.chi2, abs=1.0)
    assert from_other_nuisances(right) is right


def test_a_start_that_a_fit_took_far_from_the_record_is_looked_for_there(tmp_path):
    starts = ((0.0102, 0.0), (0.0065, -0.05), (-0.0091, 0.02))
    data = transient_data(read(write(tmp_path, STOPS, starts=starts)))
    model, right = Search.of(data, []).model(), np.array(starts) / data._scale
    off = np.array([[0.0, 0.0], [0.5, -0.4], [0.0, 0.0]])
    found = data.other_nuisances(model, model.evaluate(starting_at(model, right + off)))
    assert found[:, :2] == pytest.approx(right, abs=0.02)


def test_the_place_is_found_where_friction_holds_a_mass_far_from_the_spring_s_rest():
    # The record shows a short way, with its velocity, but not how far from rest that is.
    def misfit(starts):
        x, v = (starts - [-12.8, 3.8]).T
        return np.where(np.hypot(x, v) < 0.8, 1e4 * (x**2 + v**2), 1e6 + x**2 + v**2)

    found = best_start(misfit, [np.array([-1.0, 3.3])], places(32.0, 3.3))
    assert found == pytest.approx([-12.8, 3.8], abs=1e-3)


def test_a_minimum_along_a_cliff_is_found():
    # A valley along the cliff x = y, whose bottom is far along it.
    def misfit(starts):
        x, y = (starts - [0.3, 0.1]).T / 1e-3
        return np.where(x + 1e-9 >= y, (x + y) ** 2 + 50.0 * (x - y) ** 2, 1e4)

    start = np.array([0.3 + 4e-3, 0.1 + 4e-3])
    assert best_start(misfit, [start], places(1.0, 0.0)) == pytest.approx([0.3, 0.1], abs=2e-4)


def test_tests_stand_out_over_the_others():
    dof = np.full(9, 200)
    assert standing_out(np.full(9, 200.0), dof).size == 0
    # All are wrong alike: this is not a jump.
    assert standing_out(np.full(9, 2e6), dof).size == 0
    chi2 = np.array([200.0, 190.0, 400.0, 210.0, 9e4, 220.0, 200.0, 180.0, 205.0])
    assert standing_out(chi2, dof).tolist() == [4, 2]
    # At most a third of the tests.
    assert len(standing_out(np.array([200.0, 400.0, 210.0]), dof[:3])) == 1
