"""Energy, free decay, linear limit and similarity: what must hold whatever the numbers are."""

from math import inf, pi, sin

import numpy as np
import pytest

from tests.physics.cases import OMEGA_N, fast, steady
from wedgesweep.solvers import radau
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.equilibrium import resonance

BALANCED = [
    ("coulomb", 0.4, 1e-3),
    ("coulomb", 1.472, 0.08e-3),
    ("coulomb", 2.208, 0.1e-3),
    ("coulomb", 0.9, 3e-3),
    ("static-dynamic", 0.4, 1e-3),
    ("static-dynamic", 2.208, 0.1e-3),
    ("exponential", 1.472, 0.1e-3),
    ("exponential", 0.6, 2e-3),
]


@pytest.mark.parametrize("lean", [4.0, -4.0])
@pytest.mark.parametrize("case", BALANCED)
def test_energy_balance_over_a_steady_period(case, lean):
    law, beta, amplitude = case
    amplitude *= 1.0 if lean > 0 else 2.5  # the other lean holds the bolster much longer
    record = parameters.record(law, amplitude, beta * OMEGA_N, suspension={"column_angle": np.radians(lean)})
    numbers = fast(record, 1000).numbers
    assert numbers["dissipated_energy"] > 0.0
    assert numbers["dissipated_energy"] == pytest.approx(numbers["supplied_energy"], rel=1e-7)


@pytest.mark.acceptance
def test_energy_balance_by_radau():
    record = parameters.record("static-dynamic", 1e-3, 0.4 * OMEGA_N)
    numbers = steady(record, settle_periods=150, settled=1e-8)
    assert numbers["dissipated_energy"] == pytest.approx(numbers["supplied_energy"], rel=1e-5)


@pytest.mark.few(1)
@pytest.mark.parametrize("beta", [0.3, 1.4])
@pytest.mark.parametrize("law", ["coulomb", "exponential"])
def test_without_friction_the_response_is_the_linear_oscillator(law, beta):
    omega, amplitude = beta * OMEGA_N, 1e-4
    record = parameters.record(law, amplitude, omega, friction={"dynamic": 0.0, "static": 0.0})
    p = record[0]
    s, g, natural = p["suspension"], p["geometry"], resonance(p)
    ratio = g["column_ratio"]
    share = (s["bolster_mass"] + 2 * s["wedge_mass"] * ratio * g["cos_column"]) / (
        s["bolster_mass"] + 2 * s["wedge_mass"] * ratio**2
    )
    window = Window(omega, 2, 2, 64)
    samples = radau.solve(record, window, 1e-9, inf).samples
    forced = share * amplitude * omega**2 / (natural**2 - omega**2)
    expected = [forced * (sin(omega * t) - omega / natural * sin(natural * t)) for t in samples.t]
    np.testing.assert_allclose(samples.x, expected, atol=1e-6 * np.ptp(expected))


def test_the_regularised_laws_approach_each_other_without_decay():
    ratios = []
    for law in ("static-dynamic", "exponential"):
        friction = {"velocity_exponent": 0.0}
        record = parameters.record(law, 1e-3, 0.4 * OMEGA_N, friction=friction)
        ratios.append(steady(record, settle_periods=5)["amplitude_ratio"])
    assert ratios[0] == ratios[1]


def test_a_vanishing_threshold_velocity_approaches_set_valued_friction():
    """With one face only: two linked faces saturate one after the other, which is another limit."""

    def ratio(law, threshold):
        record = parameters.record(
            law,
            1e-3,
            0.6 * OMEGA_N,
            suspension={"column_angle": 0.0},
            friction={"dynamic": 0.0, "static": 0.0, "threshold_velocity": threshold},
            effects={"guide_friction": {"force": 1.5}},
        )
        return fast(record, 20).numbers["amplitude_ratio"]

    exact = ratio("coulomb", 1e-3)
    errors = [abs(ratio("static-dynamic", threshold) / exact - 1.0) for threshold in (1e-3, 1e-4)]
    assert errors[0] > 1e-4
    assert errors[1] < 0.2 * errors[0]


def test_normal_forces_are_unknown_while_stuck_and_known_while_slipping():
    waveforms = fast(parameters.record("coulomb", 1e-3, 0.4 * OMEGA_N), 10).waveforms
    stuck = waveforms["stuck"]
    assert 0.3 < stuck.mean() < 0.5
    assert np.isnan(waveforms["normal_force_column"][stuck]).all()
    assert np.isfinite(waveforms["normal_force_column"][~stuck]).all()
    np.testing.assert_array_equal(waveforms["velocity"][stuck], 0.0)


def test_displacement_turns_from_opposite_to_in_phase_with_the_input():
    """X - y = -z: opposite to the input far below resonance, equal to it far above; never lagging."""
    lags = {}
    for beta in (0.9, 1.14, 1.5, 3.0):
        record = parameters.record("static-dynamic", 0.5e-3, beta * OMEGA_N)
        lags[beta] = fast(record).numbers["phase_lag"]
    assert -pi < lags[0.9] < -0.85 * pi
    assert -0.75 * pi < lags[1.14] < -0.25 * pi
    assert -0.1 * pi < lags[1.5] < lags[3.0] < 0.0
