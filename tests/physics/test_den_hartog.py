"""Den Hartog's oscillator (1930): constant friction alone has a closed form to test against."""

from math import cos, inf, pi, sin, sqrt

import pytest

from tests.physics.cases import TABLE_1, steady
from wedgesweep import response
from wedgesweep.solvers import event_driven
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.suspension import parameters

M = TABLE_1["bolster_mass"] + 2 * TABLE_1["wedge_mass"]
K = TABLE_1["bolster_spring"] + 2 * TABLE_1["wedge_spring"]
AMPLITUDE = 1e-3
# A change per period that leaves the amplitude right to 1e-4 even where friction is least.
SETTLED = 1e-8

# Onset of stops F/P by frequency ratio (PHYSICS.md).
ONSETS = {0.4: 0.1439, 0.6: 0.5315, 0.8: 0.8174, 1.2: 0.7132, 1.5: 0.6466, 2: 0.5963, 3: 0.5625}


def force_amplitude(r):
    """P: amplitude of the inertia force of the base motion (N)."""
    return M * r**2 * K / M * AMPLITUDE


def driven(r, force_ratio):
    """Record of the oscillator at a frequency ratio, with guide friction F = force_ratio P."""
    return parameters.record(
        law="coulomb",
        amplitude=AMPLITUDE,
        omega=r * sqrt(K / M),
        suspension={"column_angle": 0.0},
        friction={"dynamic": 0.0, "static": 0.0},
        effects={"guide_friction": {"force": force_ratio * force_amplitude(r)}},
    )


def magnification(r, numbers):
    """K Z / P."""
    return numbers["amplitude_ratio"] * AMPLITUDE * K / force_amplitude(r)


def closed_form(r, force_ratio):
    v = 1.0 / (1.0 - r**2)
    u = sin(pi / r) / (r * (1.0 + cos(pi / r)))
    return sqrt(v**2 - (force_ratio * u) ** 2)


def respond(r, force_ratio, settle_periods=3000):
    window = Window(r * sqrt(K / M), settle_periods, 2, 256)
    case = driven(r, force_ratio)
    return response.evaluate(event_driven.solve(case, window, 1e-9, inf), case, harmonics=9).numbers


@pytest.mark.parametrize("share", [0.1, 0.5, 0.95])
@pytest.mark.parametrize("r", ONSETS)
def test_motion_without_stops(r, share):
    force_ratio = share * ONSETS[r]
    numbers = respond(r, force_ratio)
    assert magnification(r, numbers) == pytest.approx(closed_form(r, force_ratio), rel=1e-8)
    assert numbers["stick_fraction"] == 0.0


@pytest.mark.acceptance
@pytest.mark.parametrize("r", [0.8, 1.5])
def test_motion_without_stops_by_radau(r):
    force_ratio = 0.5 * ONSETS[r]
    numbers = steady(driven(r, force_ratio), settle_periods=400, rtol=1e-5, settled=SETTLED)
    assert magnification(r, numbers) == pytest.approx(closed_form(r, force_ratio), rel=1e-4)


@pytest.mark.parametrize("r", ONSETS)
def test_onset_of_stops(r):
    assert respond(r, 0.99 * ONSETS[r])["stick_fraction"] == 0.0
    assert respond(r, 1.01 * ONSETS[r])["stick_fraction"] > 0.0


@pytest.mark.parametrize(
    ("r", "expected", "stick_fraction"),
    [(0.6, 1.35193, 0.1195), (1.5, 0.16748, 0.1277), (2, 0.07010, 0.1799), (3, 0.02668, 0.2054)],
)
def test_motion_with_stops(r, expected, stick_fraction):
    numbers = respond(r, 0.7, settle_periods=400)
    assert magnification(r, numbers) == pytest.approx(expected, rel=1e-4)
    assert numbers["stick_fraction"] == pytest.approx(stick_fraction, abs=0.002)


@pytest.mark.parametrize("force_ratio", [1.0 + 1e-9, 1.5])
def test_no_motion_when_friction_exceeds_the_force(force_ratio):
    numbers = respond(1.5, force_ratio, settle_periods=5)
    assert numbers["amplitude_ratio"] == 0.0
    assert numbers["stick_fraction"] == 1.0
