"""Backbones of decays that are known in closed form, and of a bolted beam."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.command import invoke
from wedgesweep import backbone

OMEGA = 2.0 * np.pi * 8.0
TIME = np.arange(0.0, 3.0, 1e-3)
# Backbone of the first bending mode of the Brake-Reuss beam with a flat interface, from half-space contact of
# asperities: amplitude of displacement (m) at the accelerometer, circular frequency (rad/s), damping ratio.
# Porter and Brake (2023), doi 10.1016/j.ymssp.2023.110210, as tmdsimpy holds it for comparison
# (github.com/tmd-lab/tmdsimpy, examples/structures/results/brb_epmc_flat.yaml), every other point.
BEAM = np.array(
    [
        [2.4226e-07, 1058.7062, 8.9325e-04],
        [4.6465e-07, 1058.6429, 9.2879e-04],
        [8.9117e-07, 1058.4874, 1.0270e-03],
        [1.7092e-06, 1057.9685, 1.3277e-03],
        [3.2777e-06, 1056.5337, 2.1137e-03],
        [6.2824e-06, 1052.6809, 4.2608e-03],
        [1.2028e-05, 1043.9292, 7.9000e-03],
        [2.2953e-05, 1030.6579, 1.2197e-02],
        [4.2238e-05, 1010.1991, 2.0738e-02],
        [6.7400e-05, 984.4111, 3.0630e-02],
    ]
)


def both(time, signal):
    """Backbones from turning points and from the analytic signal."""
    noise = backbone.noise_std(signal)
    turns = backbone.turning_points(time, signal, noise)
    found = backbone.from_turning_points(turns)
    analytic = backbone.from_analytic_signal(time, signal, noise, turns)
    assert min(found.amplitude.size, analytic.amplitude.size) >= 5
    return found, analytic


def viscous(ratio):
    damped = OMEGA * np.sqrt(1.0 - ratio**2)
    return np.exp(-ratio * OMEGA * TIME) * np.cos(damped * TIME), damped / (2.0 * np.pi)


@pytest.mark.parametrize(("ratio", "errors"), [(0.003, (1e-4, 1e-3)), (0.05, (1e-3, 2.5e-2))])
def test_a_viscous_damper_has_one_damping_ratio_and_a_zero_does_not_matter(ratio, errors):
    signal, frequency = viscous(ratio)
    for found, error in zip(both(TIME, signal + 3.0), errors, strict=True):
        assert found.damping == pytest.approx(np.full(found.damping.size, ratio), rel=error)
        assert found.frequency == pytest.approx(np.full(found.damping.size, frequency), rel=error)


def test_dry_friction_damps_by_two_friction_over_pi_stiffness_amplitude():
    loss = 0.02  # F / k
    swing = np.floor(OMEGA * TIME / np.pi)
    size = np.maximum(1.0 - (2.0 * swing + 1.0) * loss, 0.0)
    signal = size * np.cos(OMEGA * TIME) + loss * (-1.0) ** swing
    signal[np.argmax(size == 0.0) :] = 0.0
    for found in both(TIME, signal):
        large = found.amplitude > 0.2
        assert large.sum() > 10
        assert found.damping[large] == pytest.approx(2.0 * loss / np.pi / found.amplitude[large], rel=1e-2)
        assert found.frequency[large] == pytest.approx(np.full(large.sum(), 8.0), rel=5e-3)


def test_a_cubic_spring_stiffens_with_the_square_of_the_amplitude():
    cubic, ratio = 0.2, 0.005

    def motion(_, state):
        x, v = state
        return v, -2.0 * ratio * OMEGA * v - OMEGA**2 * (x + cubic * x**3)

    signal = solve_ivp(motion, (0.0, TIME[-1]), (1.0, 0.0), t_eval=TIME, rtol=1e-9, atol=1e-11).y[0]
    for found in both(TIME, signal):
        square = cubic * found.amplitude**2
        assert np.ptp(square) > 0.05
        assert found.frequency == pytest.approx(8.0 * np.sqrt(1.0 + 0.75 * square), rel=2e-3)
        # The energy k A^2 (1/2 + square / 4) falls by c v^2; the third harmonic is A square / 32.
        decrement = ratio * np.sqrt(1.0 + 0.75 * square) * (1.0 - square / 16.0) / (1.0 + square)
        assert found.damping == pytest.approx(decrement, rel=1e-2)


def test_bands_are_the_scatter_that_noise_makes():
    signal, frequency = viscous(0.01)
    pulls = []
    for seed in range(60):
        noise = 2e-3 * np.random.default_rng(seed).standard_normal(TIME.size)
        pulls.append(
            [
                ((each.frequency - frequency) / each.frequency_std)[[2, 12, -4]].tolist()
                + ((each.damping - 0.01) / each.damping_std)[[2, 12, -4]].tolist()
                for each in both(TIME, signal + noise)
            ]
        )
    assert np.std(pulls, axis=0) == pytest.approx(np.ones((2, 6)), abs=0.3)
    assert np.abs(np.mean(pulls, axis=0)).max() < 0.5


def test_a_published_bolted_beam_rings_down_to_its_backbone():
    amplitude, omega, damping = BEAM.T

    def at(size, values):
        return np.interp(np.log(size), np.log(amplitude), values)

    time = np.arange(0.0, 1.6, 5e-5)
    rate = solve_ivp(
        lambda _, y: (-at(np.exp(y[0]), damping * omega), at(np.exp(y[0]), omega)),
        *((0.0, time[-1]), (np.log(6e-5), 0.0)),
        **{"t_eval": time, "rtol": 1e-8, "max_step": 1e-3},
    )
    found, analytic = both(time, np.exp(rate.y[0]) * np.cos(rate.y[1]))
    assert (analytic.amplitude.min() < 2e-6) & (analytic.amplitude.max() > 3e-5)
    for each in (found, analytic):
        assert 2.0 * np.pi * each.frequency == pytest.approx(at(each.amplitude, omega), rel=2e-3)
        assert each.damping == pytest.approx(at(each.amplitude, damping), rel=0.03)


MEASURED = """\
[measurement]
model = "model.toml"
[measurement.columns]
time = { column = 1, unit = "s" }
displacement = { column = 2, unit = "mm" }
[[measurement.test]]
file = "drop.csv"
kind = "transient"
"""
MODEL = """\
[oscillator]
mass_kg = 1.0
spring_N_per_mm = 2.5
normal_force_N = 1.0
[sweep]
friction_law = "coulomb"
beta = 1.0
amplitude_mm = 1.0
"""


@pytest.mark.usefixtures("empty_pictures")
def test_measured_ring_downs_are_drawn(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.savetxt("drop.csv", np.c_[TIME, viscous(0.02)[0]], delimiter=",")
    (tmp_path / "measured.toml").write_text(MEASURED)
    (tmp_path / "model.toml").write_text(MODEL)
    assert "wrote backbone.png" in invoke("plot", "backbone", "measured.toml")
    assert "there are backbone" in invoke("plot", "loop", "measured.toml", code=2)
    assert "takes no --law" in invoke("plot", "backbone", "measured.toml", "--law", "coulomb", code=2)
    still = np.where(TIME < 0.1, viscous(0.02)[0], 0.0)
    np.savetxt("drop.csv", np.c_[TIME, still], delimiter=",")
    assert "drop has 2 turning points" in invoke("plot", "backbone", "measured.toml", code=2)
