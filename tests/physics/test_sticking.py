"""A wedge that sticks under a sampled input breaks away where the base has accelerated enough."""

import numpy as np
import pytest
from numpy.random import default_rng

from wedgesweep import excitation
from wedgesweep.compiled import compiled
from wedgesweep.config import from_document
from wedgesweep.sampled_input import bend_leaves, from_samples, set_sampled
from wedgesweep.solvers import periodic
from wedgesweep.systems import compact, state_count
from wedgesweep.systems.suspension.rest import breakaway_inputs, rest_interval

CONFIG = from_document(
    {"suspension": {}, "sweep": {"friction_law": "coulomb", "beta": 1.0, "amplitude_mm": 1.0}}
)
LENGTH, OMEGA = 1e-3, 85.0


@compiled
def _leaves(rows, t, stop, low, high):
    return bend_leaves(t, stop, low, high, rows[0])


def _record(given, span, effects=None):
    """Record of the paper's bench under a sampled input."""
    row = CONFIG.record_with(effects or {}, "coulomb", 1.0, OMEGA)
    set_sampled(row, given, LENGTH, OMEGA, span)
    return row


@pytest.mark.parametrize("seed", range(20))
def test_the_range_of_an_acceleration_is_left_where_dense_samples_leave_it(seed):
    rng = default_rng(seed)
    given = from_samples(rng.normal(size=40), 0.01, "acceleration", begin=0.05)
    t = np.linspace(0.0, 0.5, 200_001)
    bend = given(t, 2)
    low, high = -rng.uniform(0.5, 3.0), rng.uniform(0.5, 3.0)
    found, side = _leaves(compact(_record(given, 0.5)), 0.0, 0.5, low / LENGTH, high / LENGTH)
    outside = (bend < low) | (bend > high)
    if not outside.any():
        assert (found, side) == (0.5, 0)
        return
    first = np.argmax(outside)
    assert t[first] - 3e-6 < found <= t[first] + 1e-12
    assert side == (1 if bend[first] > high else -1)


def test_a_range_without_zero_is_left_before_the_samples_begin_and_after_they_end():
    given = from_samples(np.full(20, 2.0), 0.01, "acceleration", begin=0.1)
    rows = compact(_record(given, 1.0))
    assert _leaves(rows, 0.02, 1.0, 1.0 / LENGTH, 3.0 / LENGTH) == (0.02, -1)
    after, side = _leaves(rows, 0.12, 1.0, 1.0 / LENGTH, 3.0 / LENGTH)
    assert (after, side) == (pytest.approx(given.end), -1)
    assert _leaves(rows, 0.02, 1.0, -1.0 / LENGTH, 3.0 / LENGTH) == (1.0, 0)


def test_a_bolster_that_sticks_without_input_rests():
    """As after a release: its input was taken for a sine of the amplitude that motions are compared with."""
    row = CONFIG.record_with({}, "coulomb", 1.0, OMEGA)
    excitation.set_no_motion(row, LENGTH)
    run = periodic.sampled(row, np.zeros((1, state_count())), 0, 3, 64, 1e-8)
    assert not run.velocity.any()


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("locked_in", "gain"),
    [(0.0, 1.0), *(pytest.param(*each, marks=pytest.mark.acceptance) for each in ((0.3, 1.0), (0.0, 1.25)))],
)
def test_a_bolster_breaks_away_when_a_growing_acceleration_reaches_that_of_breakaway(sign, locked_in, gain):
    growth, span, samples = 1.0, 1.0, 200_000
    time = np.arange(2001) * 5e-4
    begin = 0.1
    given = from_samples(sign * (begin + growth * time), 5e-4, "acceleration")
    effects = {"jamming": {"locked_in": locked_in}, "input_gain": {"scale": gain}}
    row = _record(given, span, effects)
    expected = (_breakaway(row, sign, locked_in) / gain - begin) / growth
    assert 0.1 < expected < 0.9
    run = periodic.sampled(row, np.zeros((1, state_count())), 0, 1, samples, 1e-10)
    moves = np.flatnonzero(run.velocity[0] != 0.0)[0] / samples
    assert moves == pytest.approx(expected, abs=2.0 / samples)


def _breakaway(row, side, locked_in):
    """Size of the base acceleration (m/s^2) to one side at which the bolster leaves its equilibrium."""
    mu = row["friction"]["mu_d"]
    least, most = (ends[side > 0][0] for ends in (breakaway_inputs(row, mu), rest_interval(row, mu)))
    return abs(float(least + locked_in * (most - least)))
