"""The campaign's own simulator (scripts/blind_outside.py) shares nothing with wedgesweep, but agrees."""

import importlib
from math import pi

import numpy as np
import pytest

from wedgesweep import parameters, response, tally
from wedgesweep.friction import LAW_NAMES
from wedgesweep.solvers import event_driven
from wedgesweep.solvers.march import workspace
from wedgesweep.sweep import dataset

PHASES, SETTLE = 128, 60


@pytest.fixture
def outside(scripts):
    return importlib.import_module("blind_outside")


@pytest.mark.parametrize("law", LAW_NAMES)
@pytest.mark.parametrize(("frequency", "amplitude"), [(8.0, 0.8e-3), (24.0, 0.1e-3)])
def test_without_its_effects_it_is_the_base_model(outside, law, frequency, amplitude):
    system = outside.system(law, 4.0, frequency, amplitude, {})
    stride = round(1.0 / frequency / 5e-6 / PHASES)
    step = 1.0 / frequency / PHASES / stride
    signal, force = outside.follow(system, step, SETTLE * PHASES * stride, stride, PHASES)
    record = parameters.record(law, amplitude, 2.0 * pi * frequency)
    batch = event_driven.empty_batch(1, dataset.HARMONICS, 0)
    plan = event_driven.Plan(1, PHASES, True, 1e-8, 400)
    event_driven.run_batch(record, np.zeros(1, np.int64), plan, tally.empty(), workspace(1e-9), batch)
    turn = np.exp(-2j * pi * np.outer(np.arange(PHASES) / PHASES, np.arange(1, dataset.HARMONICS + 1)))
    ours = batch.spectra[0, 0] @ [1.0, 1j]
    theirs = -2.0 / PHASES * signal[0] @ turn
    np.testing.assert_allclose(theirs, ours, atol=1e-3 * abs(ours[0]))
    least = batch.numbers[0, response.NUMBERS.index("minimum_normal_force")]
    assert force == pytest.approx(least, abs=2e-3)


@pytest.mark.parametrize("effect", [{"width": 0.0}, {"coefficient": 0.0}, {"friction": 1.0}])
def test_effects_are_absent_at_zero(outside, effect):
    base = outside.system("exponential", 4.0, 20.0, 1e-4, {})
    assert outside.system("exponential", 4.0, 20.0, 1e-4, effect) == base


def test_backlash_takes_the_slack_out_of_the_spring_force(outside):
    loose = outside.system("coulomb", 4.0, 20.0, 1e-4, {"width": 2e-5, "coefficient": 1.0})
    tight = loose._replace(width=0.0)

    def pull(z, v, system):
        return outside.solve_newton(system.rest + z, v, 0.0, 0.0, 0.0, system)[0]

    per_newton = pull(0.0, -1.0, tight)  # a drag of 1 N pushes up
    for z, slack in ((5e-5, 1e-5), (5e-6, 5e-6), (-3e-5, -1e-5)):
        given = outside.BOLSTER_SPRING * slack * per_newton
        assert pull(z, 0.0, loose) == pytest.approx(pull(z, 0.0, tight) + given, rel=1e-9)
