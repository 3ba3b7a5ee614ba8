"""Base motion as a Fourier series: what a recorded input becomes."""

from math import pi

import numpy as np
import pytest

from tests.physics.cases import OMEGA_N
from wedgesweep import excitation
from wedgesweep.compiled import compiled
from wedgesweep.solvers import periodic
from wedgesweep.systems.suspension import parameters

SECOND, PHASE, THIRD, THIRD_PHASE = 0.1, 0.5, 0.05, 0.5 * pi
DISTORTION = {"second": SECOND, "second_phase": PHASE, "third": THIRD, "third_phase": THIRD_PHASE}
# sin(h wt + phase) = Re -i exp(i phase) exp(i h wt)
SHAPE = -1j * np.array([1.0, SECOND * np.exp(1j * PHASE), THIRD * np.exp(1j * THIRD_PHASE)])


def case(shape=SHAPE, effects=None, law="static-dynamic"):
    record = parameters.record(law, 0.4e-3, 0.5 * OMEGA_N, effects=effects or {})
    excitation.set_series(record, shape)
    return record


@compiled
def base_motion(t, case, out):
    p = case[0]
    out[0], out[1] = excitation.displacement(t, p), excitation.velocity(t, p)
    out[2] = excitation.acceleration(t, p)


def motion(t, record):
    out = np.zeros(3)
    base_motion(t, parameters.compact(record), out)
    return out


def steady(record):
    found = periodic.respond(record, periodic.at_rest(1), periodic.Accuracy(1e-10, 40, 1e-10), 256, 16)
    assert found.outcome[0] == periodic.OK
    assert found.stuck[0] > 0.05
    return found.spectra[0]


def test_velocity_and_acceleration_are_derivatives_of_the_displacement():
    step, record = 1e-6, case()
    for t in (0.0, 0.013, 0.1):
        before, here, after = (motion(t + each * step, record) for each in (-1, 0, 1))
        slope = (after - before) / (2.0 * step)
        np.testing.assert_allclose(here[1:], slope[:2], rtol=1e-6)


def test_one_harmonic_is_the_sine_of_the_paper_and_costs_nothing():
    record = parameters.record("static-dynamic", 0.4e-3, 0.5 * OMEGA_N)
    assert "series" not in (parameters.compact(record).dtype.names or ())
    assert not excitation.has_series(record)[0]
    plain = motion(0.013, record)
    phase = 0.5 * OMEGA_N * 0.013
    assert plain[0] == 0.4e-3 * np.sin(phase)
    # A record with room for a series gives the same sine.
    both = np.concatenate([record, case()])
    np.testing.assert_allclose(motion(0.013, both), plain, rtol=1e-14)


@pytest.mark.parametrize("law", ["coulomb", "static-dynamic", "exponential"])
def test_the_same_harmonics_as_an_effect_give_the_same_response(law):
    """As harmonics power series follow slip and tell when a bolster breaks away; as an effect Runge-Kutta."""
    there = steady(case(excitation.SINE, {"input_distortion": DISTORTION}, law))
    here = steady(case(law=law))
    assert np.abs(here - there).max() < 1e-9 * np.abs(there).max()
    assert np.abs(here - steady(case(excitation.SINE, law=law))).max() > 0.1 * np.abs(there).max()


def test_noise_in_high_orders_needs_no_short_steps():
    noisy = np.zeros(16, complex)
    noisy[:3], noisy[3:] = SHAPE, 2e-4 * np.exp(1j * np.arange(13))
    record = case(noisy)
    # Second and third order carry 12 and 15 % of the mean square acceleration, the noise 0.7 %.
    assert record["series"]["resolved"][0] == 3
    every = record.copy()
    every["series"]["resolved"] = 16
    there, here = steady(every), steady(record)
    assert np.abs(here - there).max() < 1e-7 * np.abs(there).max()


def test_an_order_that_carries_acceleration_is_resolved():
    strong = np.append(-1j, np.zeros(15))
    strong[15] = 1e-3  # a quarter of the fundamental's acceleration
    assert case(strong)["series"]["resolved"][0] == 16
    assert case(excitation.SINE)["series"]["resolved"][0] == 1
