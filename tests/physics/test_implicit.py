"""The implicit steps x, dense output, and no step over what runs away."""

from math import inf

import numpy as np
import pytest

from tests.physics import compiled_mechanics as mechanics
from tests.physics.cases import OMEGA_N
from wedgesweep.solvers import event_driven, periodic
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.modes import ContactMode

ON_RAMPS = ContactMode(0, 0, 0, 0, 1, 1, 0, 1)
COLUMN = "column_compliance"


def record(law="static-dynamic", **friction):
    effects = {"column_compliance": {"stiffness": 3e5}}
    return mechanics.with_all_mechanics(parameters.record(law, 1e-4, OMEGA_N, {}, friction, effects))


def moving(record, **velocities):
    """State with only velocities: of the mass, of the column."""
    return mechanics.initial_state(
        record[0], {("", 1): velocities.get("mass", 0.0), (COLUMN, 1): velocities.get("column", 0.0)}
    )


def after(step, record, start, duration, steps):
    """State after some even steps, and halfway through the last by the dense output."""
    y, t, h = start, 0.0, duration / steps
    for _ in range(steps):
        y, middle, _ = step(t, h, y, ON_RAMPS, record[0], 1e-6)
        t += h
    return np.array(y), np.array(middle)


@pytest.mark.acceptance
@pytest.mark.parametrize(("place", "order"), [(0, 4), (1, 3)], ids=["end", "dense output"])
def test_order_on_a_gentle_ramp(place, order):
    gentle = record(threshold_velocity=1.0)
    start = moving(gentle, mass=0.02, column=-0.01)
    true = [after(mechanics.explicit_step, gentle, start, 4e-3, 4 * n)[0] for n in (64, 128)]
    assert np.abs(true[0] - true[1]).max() < 1e-12
    errors = []
    for steps in (16, 32):
        end, middle = after(mechanics.implicit_step, gentle, start, 4e-3, steps)
        if place == 0:
            errors.append(np.abs(end - true[1]).max())
        else:
            half = after(mechanics.explicit_step, gentle, start, 4e-3 * (1 - 0.5 / steps), 512)[0]
            errors.append(np.abs(middle - half).max())
    assert np.log2(errors[0] / errors[1]) > order - 0.3


def work(case, rtol):
    """Rate evaluations of five periods from rest."""
    window = Window(float(case["input"]["omega"][0]), 0, 5, 64)
    return event_driven.solve(case, window, rtol, inf).statistics["rate_evaluations"]


def test_steps_become_shorter_with_the_tolerance_as_the_order_says():
    soft = parameters.record(
        "coulomb", 1e-4, 1.4 * OMEGA_N, effects={"column_compliance": {"stiffness": 1e4}}
    )
    # One over the fourth root of 1e-2 is 3.2; derivatives off by 1e-5 made it 30.
    assert work(soft, 1e-8) < 4.0 * work(soft, 1e-6)


def test_bristles_become_no_work_as_they_become_short():
    cases = [
        parameters.record("coulomb", 3e-4, OMEGA_N, effects={"presliding": {"length": length}})
        for length in (1e-6, 1e-8)
    ]
    long, short = (work(case, 1e-6) for case in cases)
    assert short < 3.0 * long


def test_short_bristles_are_friction_that_holds_but_for_the_time_of_their_way():
    base = parameters.record("coulomb", 3e-4, OMEGA_N)
    true = periodic.respond(base, periodic.at_rest(1), periodic.Accuracy(1e-9, 400, 1e-9), 256, 8).spectra[0]
    apart = []
    for length in (4e-8, 1e-8):
        case = parameters.record("coulomb", 3e-4, OMEGA_N, effects={"presliding": {"length": length}})
        found = periodic.respond(case, periodic.at_rest(1), periodic.Accuracy(1e-6, 400, 1e-6), 256, 8)
        apart.append(np.abs(found.spectra[0] - true).max() / np.abs(true).max())
    # From a turn the slip grows evenly: the way takes a time as its square root.
    assert apart[0] < 0.01
    assert apart[0] / apart[1] == pytest.approx(2.0, rel=0.01)


def test_what_runs_away_is_not_stepped_over():
    p = record()[0]
    velocities = np.flatnonzero(moving(record(), mass=1.0, column=1.0))
    slopes = np.zeros((len(moving(record())),) * 2)
    # Eigenvalues (-3 +- sqrt(13)) / 2 in 1e6.
    slopes[np.ix_(velocities, velocities)] = [[-2e6, 1e6], [3e6, -1e6]]
    assert mechanics.growth(slopes, p) == pytest.approx(0.5 * (13**0.5 - 3) * 1e6)
    slopes[1, 1] = -9e6
    assert mechanics.growth(slopes, p) < 0.0


@pytest.mark.acceptance
def test_a_step_that_would_damp_what_runs_away_is_refused():
    driven = parameters.record(
        "static-dynamic",
        1e-4,
        OMEGA_N,
        effects={COLUMN: {"stiffness": 3e5}, "viscous_damping": {"coefficient": -1e6}},
    )
    driven = mechanics.with_all_mechanics(driven)
    start = moving(driven)
    refused, made = (
        mechanics.implicit_step(0.0, h, start, ON_RAMPS, driven[0], 1e-6)[2] for h in (1e-4, 1e-8)
    )
    assert refused == np.inf
    assert made < np.inf
