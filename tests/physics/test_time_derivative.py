"""RODAS needs the derivative of the rate by time, however long a recorded input is."""

from math import pi

import numpy as np
import pytest

from wedgesweep.compiled import compiled
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.vectors import vector
from wedgesweep.sampled_input import from_samples, set_sampled
from wedgesweep.solvers import implicit
from wedgesweep.systems import compact
from wedgesweep.systems.suspension import parameters

AMPLITUDE, OMEGA, STEP = 1e-3, 2.0 * pi * 5.0, 2e-3
FRICTIONLESS = {"dynamic": 0.0, "static": 0.0}


@compiled
def by_time(t, cases):
    """Derivative of the rate of a bolster at rest."""
    p = cases[0]
    y = vector(np.zeros(len(interface.scales(p))), interface.scales(p))
    mode = interface.initial_mode(t, y, p)[0]
    return implicit._derivatives(t, y, interface.rate(t, y, mode, p)[0], mode, p)[1]


@pytest.mark.acceptance
@pytest.mark.parametrize("seconds", [4.0, 2000.0])
def test_the_rate_changes_with_the_third_derivative_of_the_base(seconds):
    samples = AMPLITUDE * np.sin(OMEGA * np.arange(0.0, seconds, STEP))
    effects = {"presliding": {"length": 1e-4}}
    case = parameters.record("static-dynamic", AMPLITUDE, OMEGA, {}, FRICTIONLESS, effects)
    given = from_samples(samples, STEP, "displacement")
    set_sampled(case, given, AMPLITUDE, OMEGA, seconds)
    t, moment = 1.0123, 1e-5
    # Without friction masses alone decide how much of the base's acceleration drives the bolster.
    share = parameters.driven_mass(case)[0] / parameters.moving_mass(case)[0]
    expected = share * np.diff(given(np.array([t - moment, t + moment]), 2))[0] / (2.0 * moment)
    assert by_time(t, compact(case))[1] == pytest.approx(-expected, rel=1e-4)
