"""The derivative of the map across an impact is that of both flights with the saltation matrix in between.

S = DR + (f+ - DR f-) grad(h) / (grad(h) . f-), with the jump R of the state where the gap h is zero and the
rates f of the state before and after it: Leine and Nijmeijer (2004), ch. 7. Shooting takes differences of
runs that stop at every event. Here these are compared with S, made from the law of impacts alone.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.physics import compiled_unilateral as mechanics
from tests.physics.test_unilateral import BOLSTER_GAP, COLUMN_GAP, record
from wedgesweep import excitation
from wedgesweep.solvers.period_map import memory, prepared, run_periods
from wedgesweep.systems import compact

SPAN, SHARE, AMPLITUDE = 2e-3, 1e-8, 1e-3
# Gaps (m) of a face that is about to hit, and of one that is far away.
NEAR, FAR = 4e-4, 5e-3
STATES = np.arange(6)


class Bench:
    """A bench without an input, whose wedges fly: its flow over a time, and how many events that meets."""

    def __init__(self, restitution):
        self.case = record("coulomb", restitution=restitution, column_angle=-0.07)
        excitation.set_no_motion(self.case, AMPLITUDE)
        self.compact = compact(self.case)

    def flow(self, y, span):
        """State after a time (s), and number of events on the way."""
        self.case["input"]["omega"] = 2.0 * np.pi / span
        room, after = memory(1e-12, 8, 1), np.array(y)
        assert run_periods(prepared(compact(self.case)), 0, 1, after, True, room) == 0
        return after, room.work.counts[2]

    def derivative(self, function, y):
        """Derivative of a function of the state by central differences."""
        columns = []
        for place in STATES:
            step = SHARE * (place == STATES)
            columns.append((function(y + step) - function(y - step)) / (2.0 * SHARE))
        return np.array(columns).T

    def flight(self, span):
        """Derivative of the flow over a time in flight, where it is linear."""
        away = np.where((STATES == COLUMN_GAP) | (STATES == BOLSTER_GAP), FAR, 0.0)
        return self.derivative(lambda y: self.flow(y, span)[0], away)

    def struck(self, y, gap):
        """The state after the impact of one face, while the other one is open: only velocities jump."""
        column, touching = gap == COLUMN_GAP, np.where(gap == STATES, 0.0, y)
        restitution = float(self.case["lift_off"]["restitution"][0])
        after = np.array(mechanics.struck(tuple(touching), column, not column, restitution, self.compact)[0])
        return np.where(STATES % 2 == 1, after, y)


def saltation(jump, before, after, gap):
    """The saltation matrix of an impact, from the derivative DR of its jump and the rates of the state."""
    normal = (gap == STATES).astype(float)
    return jump + np.outer(after - jump @ before, normal) / before[gap]


@pytest.mark.acceptance
@pytest.mark.parametrize("gap", [COLUMN_GAP, BOLSTER_GAP])
@pytest.mark.parametrize("restitution", [0.3, 0.8])
@pytest.mark.parametrize("seed", [0])
def test_differences_across_an_impact_hold_its_saltation_matrix(gap, restitution, seed):
    bench, random = Bench(restitution), np.random.default_rng([seed, gap])
    start = np.zeros(6)
    start[0], start[1] = random.uniform(-2e-3, 2e-3), random.uniform(-0.3, 0.3)
    start[[COLUMN_GAP, BOLSTER_GAP]] = FAR
    start[gap], start[gap + 1] = NEAR, -random.uniform(0.5, 1.0)
    start[COLUMN_GAP + BOLSTER_GAP + 1 - gap] = random.uniform(-0.3, 0.3)
    end, events = bench.flow(start, SPAN)
    assert events == 1
    moment = brentq(lambda t: bench.flow(start, t)[0][gap] - 1e-9, 1e-6, _last(bench, start, gap))
    before = bench.flow(start, moment)[0]
    rate_before = np.array(mechanics.rate_at(0.0, tuple(before), bench.compact))
    # The last nanometre of the flight, straight on.
    rest = before[gap] / -rate_before[gap]
    before, moment = before + rest * rate_before, moment + rest
    before[gap] = 0.0
    after = bench.struck(before, gap)
    rate_after = np.array(mechanics.rate_at(0.0, tuple(after), bench.compact))
    jump = bench.derivative(lambda y: bench.struck(y, gap), before)
    matrix = saltation(jump, rate_before, rate_after, gap)
    expected = bench.flight(SPAN - moment) @ matrix @ bench.flight(moment)
    found = bench.derivative(lambda y: bench.flow(y, SPAN)[0], start)
    # Units: an error of a velocity by a position is compared with the frequency of the wedge on its spring.
    units = np.where(STATES % 2 == 1, 100.0, 1.0)
    assert found / np.divide.outer(units, units) == pytest.approx(
        expected / np.divide.outer(units, units), rel=1e-4, abs=1e-4
    )
    assert end == pytest.approx(bench.flow(after, SPAN - moment)[0], abs=1e-9)


def _last(bench, start, gap):
    """A time (s) shortly before the impact up to which no event is met, by bisection."""
    low, high = 0.0, SPAN
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if bench.flow(start, middle)[1] else (middle, high)
    return low
