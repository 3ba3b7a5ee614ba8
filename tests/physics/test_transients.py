"""Motions under inputs that do not repeat, through ``run``, against closed forms; both solvers."""

from math import cos, exp, pi, sin, sqrt

import numpy as np
import pytest

from wedgesweep import config, excitation, sampled_input
from wedgesweep.compiled import compiled
from wedgesweep.solvers import periodic
from wedgesweep.sweep.run import Sweep
from wedgesweep.systems import state_count
from wedgesweep.systems.oscillator import parameters as oscillator
from wedgesweep.systems.suspension import parameters as suspension

EACH_SOLVER = pytest.mark.parametrize(
    "method", ["event-driven", pytest.param("radau", marks=pytest.mark.acceptance)]
)
MASS, SPRING = 2.0, 800.0
OMEGA = sqrt(SPRING / MASS)
PERIOD = 2.0 * pi / OMEGA
HEAVY = {"mass": 1.0, "spring": 900.0, "damping": 1.0, "normal_force": 3.0}  # SI
LINEAR = {"mass_kg": MASS, "spring_N_per_mm": SPRING / 1e3, "normal_force_N": 0.0}


def run(given, own=LINEAR, method="event-driven", rtol=1e-9, friction=None, law="coulomb", scale=1.0):
    """The only case of a config with this input."""
    document = {
        "oscillator": own,
        "friction": friction or {},
        "input": given,
        "sweep": {"friction_law": law, "scale": scale},
        "solver": {"method": method, "rtol": rtol},
    }
    ds = Sweep(config.from_document(document), "a.nc").run_here().squeeze()
    assert ds["status"] == 0, ds["message"].item()
    return ds


def damped(ratio):
    return LINEAR | {"damping_N_s_per_m": 2.0 * ratio * MASS * OMEGA}


@EACH_SOLVER
@pytest.mark.parametrize("contact", ["base", "ground"])
def test_a_free_decay_loses_four_friction_over_stiffness_a_cycle(method, contact):
    friction, start, cycles = 1.7, 0.03, 3
    given = {
        "kind": "release",
        "displacement_mm": start * 1e3,
        "duration_s": cycles * PERIOD,
        "sampling_hz": 16 / PERIOD,
    }
    own = LINEAR | {"normal_force_N": friction, "contact": contact}
    ds = run(given, own, method, 1e-10, {"dynamic": 1.0, "static": 1.0}, scale=1.5)
    peaks = ds["displacement"].values[::8]
    n = np.arange(peaks.size)
    expected = (-1.0) ** n * (1.5 * start - 2.0 * friction / SPRING * n)
    assert peaks == pytest.approx(expected, abs=1e-8 * start)
    lost = 0.5 * SPRING * (peaks[0] ** 2 - (1.5 * start - 4.0 * cycles * friction / SPRING) ** 2)
    assert ds["dissipated_energy"].item() == pytest.approx(lost, rel=1e-7)
    assert ds["supplied_energy"].item() == pytest.approx(0.0, abs=1e-12)


@EACH_SOLVER
def test_acceleration_is_what_the_forces_give(method):
    given = {
        "kind": "sine-sweep",
        "amplitude_m_per_s2": 6.0,
        "start_hz": 2.0,
        "stop_hz": 5.0,
        "duration_s": 1.0,
    }
    own = damped(0.05) | {"normal_force_N": 3.0}
    ds = run(given, own, method, friction={"dynamic": 0.5, "static": 0.7}, law="static-dynamic")
    v = ds["velocity"].values
    slips = np.abs(v) > 1e-3
    spring = SPRING * ds["displacement"] + own["damping_N_s_per_m"] * v
    force = -spring - 1.5 * np.sign(v) - MASS * ds["input"]
    assert slips.sum() > 100
    assert ds["acceleration"].values[slips] == pytest.approx(force.values[slips] / MASS, abs=1e-8)


@pytest.mark.parametrize(
    ("case", "omega"),
    [
        (oscillator.record("static-dynamic", 3e-3, 20.0, HEAVY), 20.0),
        (suspension.record("static-dynamic", 3e-3, 60.0), 60.0),
    ],
    ids=["oscillator", "suspension"],
)
def test_a_sampled_sine_gives_the_response_to_the_sine(case, omega):
    periods, count, rest = 5, 64, np.zeros((1, state_count()))
    sine = periodic.sampled(case, rest, 0, periods, count, 1e-9).x
    step = 2.0 * pi / omega / count
    samples = 3e-3 * np.sin(omega * step * np.arange(2 * periods * count))
    given = sampled_input.from_samples(samples, step, fastest=omega)
    case = case.copy()
    sampled_input.set_sampled(case, given, 3e-3, omega, periods * 2.0 * pi / omega)
    sampled = periodic.sampled(case, rest, 0, 1, periods * count, 1e-9).x
    assert sampled == pytest.approx(sine, abs=2e-7 * np.abs(sine).max())


@pytest.mark.parametrize(
    ("quantity", "close"), [("displacement", 3e-7), ("velocity", 2e-5), ("acceleration", 3e-7)]
)
def test_the_input_and_its_rates_agree(quantity, close):
    omega, step = 12.0, 2.0 * pi / 12.0 / 64
    t = step * np.arange(300)
    wanted = (np.sin(omega * t), omega * np.cos(omega * t), -(omega**2) * np.sin(omega * t))
    order = sampled_input.INTEGRATED[quantity]
    made = sampled_input.from_samples(wanted[order], step, quantity, start=(0.0, omega))
    # The ends of a spline are less exact.
    inside = np.linspace(t[30], t[-30], 1777)
    assert made(inside) == pytest.approx(np.sin(omega * inside), abs=1e-4)
    assert made(inside, 2) == pytest.approx(-(omega**2) * np.sin(omega * inside), abs=close * omega**2)
    near = 1e-6
    for k in (0, 1):
        slope = (made(inside[1:-1] + near, k) - made(inside[1:-1] - near, k)) / (2.0 * near)
        assert made(inside[1:-1], k + 1) == pytest.approx(slope, abs=1e-6 * omega ** (k + 1))


def test_beyond_its_ends_the_base_keeps_its_velocity():
    made = sampled_input.from_samples(np.array([0.0, 1.0, 4.0, 9.0, 16.0]), 1.0)
    assert made(np.array([-1.0, 4.0, 6.0])) == pytest.approx([0.0, 16.0, 32.0], abs=1e-12)
    assert made(np.array([-1.0, 6.0]), 1) == pytest.approx([0.0, 8.0], abs=1e-12)
    assert made(np.array([-1.0, 2.0, 6.0]), 2) == pytest.approx([0.0, 2.0, 0.0], abs=1e-12)


@compiled
def _compiled_input(t, cases, out):
    p = cases[0]
    for i in range(t.size):
        out[0, i], out[1, i] = excitation.displacement(t[i], p), excitation.velocity(t[i], p)
        out[2, i] = excitation.acceleration(t[i], p)


def test_compiled_code_sees_the_same_input():
    values = np.random.default_rng(1).normal(size=40)
    made = sampled_input.from_samples(values, 0.02, begin=0.1)
    case = oscillator.record("coulomb", 1.0, 1.0, {"mass": 1.0, "spring": 100.0})
    sampled_input.set_sampled(case, made, 0.7, 30.0, 1.0, gain=-1.5)
    t = np.sort(np.random.default_rng(2).uniform(0.0, 1.0, 500))
    found = np.empty((3, t.size))
    _compiled_input(t, oscillator.compact(case), found)
    for k in range(3):
        assert found[k] == pytest.approx(-1.5 * made(t, k), abs=1e-10 * 50.0**k)


def test_a_slow_sine_sweep_follows_the_transfer_function():
    ratio = 0.25
    given = {
        "kind": "sine-sweep",
        "amplitude_mm": 1.0,
        "start_hz": 1.0,
        "stop_hz": 5.0,
        "rate": "linear",
        "duration_s": 300.0,
        "sampling_hz": 50.0,
    }
    ds = run(given, damped(ratio), rtol=1e-7)
    beta = 2.0 * pi * ds["input_frequency"].values / OMEGA
    magnification = beta**2 / np.sqrt((1.0 - beta**2) ** 2 + (2.0 * ratio * beta) ** 2)
    # Amplitude of a sine from its value and its rate.
    omega = beta * OMEGA
    found = np.hypot(ds["displacement"].values, ds["velocity"].values / omega)
    settled = slice(1000, None)
    assert found[settled] == pytest.approx(1e-3 * magnification[settled], rel=0.01)


def test_random_acceleration_of_a_linear_oscillator_has_the_known_variance():
    ratio, high, duration, rms = 0.05, 30.0, 150.0, 2.0
    given = {
        "kind": "random",
        "rms_m_per_s2": rms,
        "start_hz": 0.05,
        "stop_hz": high,
        "seed": 3,
        "duration_s": duration,
    }
    ds = run(given, damped(ratio), rtol=1e-6)
    assert ds["input"].std().item() == pytest.approx(rms, rel=1e-3)
    lines = 2.0 * pi * np.arange(1, int(high * duration) + 1) / duration
    lines = lines[lines >= 2.0 * pi * 0.05]
    transfer = 1.0 / np.abs(OMEGA**2 - lines**2 + 2j * ratio * OMEGA * lines) ** 2
    exact = rms**2 * transfer.mean()
    # White noise of two-sided density S_0 over angular frequency.
    white = pi * (rms**2 / (2.0 * 2.0 * pi * high)) / (2.0 * ratio * OMEGA**3)
    variance = ds["displacement"].var().item()
    assert exact == pytest.approx(white, rel=0.03)
    # From rest the variance builds up as 1 - exp(-2 zeta omega t): that much is missing of the mean.
    missing = 1.0 / (2.0 * ratio * OMEGA * duration)
    assert variance == pytest.approx(exact * (1.0 - missing), rel=0.02)


def test_gaussian_noise_has_a_new_spectrum_with_every_seed_and_the_same_with_one():
    given = {
        "kind": "random",
        "rms_N": 3.0,
        "frequency_hz": [2.0, 4.0, 8.0],
        "level": [1.0, 4.0, 0.25],
        "duration_s": 60.0,
        "periodic": False,
    }
    made = [config_input(given | {"seed": seed}) for seed in (1, 1, 2)]
    assert np.array_equal(made[0].given, made[1].given)
    assert not np.allclose(made[0].given, made[2].given)
    assert made[0].given.std() == pytest.approx(3.0, rel=0.1)
    power = np.abs(np.fft.rfft(made[0].given[:-1])) ** 2
    hz = np.fft.rfftfreq(made[0].given.size - 1, made[0].step)

    def mean(low, high):
        return power[(hz > low) & (hz < high)].mean()

    assert mean(3.5, 4.5) / mean(2.0, 2.5) == pytest.approx(2.7, rel=0.5)
    assert mean(9.0, 11.0) < 0.01 * mean(7.0, 8.0)


def config_input(given):
    document = {"oscillator": LINEAR, "input": given, "sweep": {"friction_law": "coulomb"}}
    return config.from_document(document).input


def test_a_step_of_velocity_of_the_base_sets_the_mass_in_motion():
    given = {"kind": "ramp", "velocity_mm_per_s": 100.0, "duration_s": 3.0 * PERIOD}
    ds = run(given, LINEAR | {"contact": "ground"})
    t = ds["time"].values
    assert ds["displacement"].values == pytest.approx(0.1 * (t - np.sin(OMEGA * t) / OMEGA), abs=1e-9)


def test_a_release_with_a_velocity_rings_down():
    ratio, start, velocity = 0.08, 0.02, -0.3
    given = {
        "kind": "release",
        "displacement_mm": start * 1e3,
        "velocity_mm_per_s": velocity * 1e3,
        "duration_s": 2.0,
    }
    ds = run(given, damped(ratio))
    decay, turn = ratio * OMEGA, OMEGA * sqrt(1.0 - ratio**2)
    expected = [
        exp(-decay * t) * (start * cos(turn * t) + (velocity + decay * start) / turn * sin(turn * t))
        for t in ds["time"].values
    ]
    assert ds["displacement"].values == pytest.approx(expected, abs=1e-9)


# Suspensions and oscillators, three laws, effects; 12, 20, 24 and 28 of the script would compile for minutes.
@pytest.mark.acceptance
def test_bristles_pulled_by_a_spring_end_where_they_are_published_to_end():
    """Exudyn's test example of a LuGre friction oscillator: x and z at 25 s."""
    given = {"kind": "ramp", "velocity_mm_per_s": 100.0, "duration_s": 25.02, "sampling_hz": 50.0}
    own = {
        **{"mass_kg": 1.0, "spring_N_per_mm": 2e-3, "normal_force_N": 1.0, "contact": "ground"},
        **{"bristle_stiffness_N_per_mm": 100.0, "bristle_damping_N_s_per_m": sqrt(1e5)},
        "bristle_viscous_N_s_per_m": 0.4,
    }
    friction = {"dynamic": 1.0, "static": 1.5, "threshold_velocity_mm_per_s": 1.0}
    ds = run(given, own, friction=friction, law="lugre").sel(time=25.0, method="nearest")
    assert ds["time"].item() == pytest.approx(25.0, abs=1e-12)
    assert ds["displacement"].item() == pytest.approx(1.9088391992, abs=1e-8)
    # z from the balance of forces: k (u - x) - M x'' - sigma_2 v = sigma_0 z + sigma_1 z'.
    v, damping = ds["velocity"].item(), sqrt(1e5)
    held = 2.0 * (2.5 - ds["displacement"].item()) - ds["acceleration"].item() - 0.4 * v
    level = 1.0 + 0.5 * exp(-((v / 1e-3) ** 2))
    z = (held - damping * v) / (1e5 * (1.0 - damping * abs(v) / level))
    assert z == pytest.approx(1.18167955e-5, rel=1e-6)


@pytest.mark.acceptance
def test_soft_bristles_creep_by_their_stiffness_before_they_slip():
    stiffness = 4e4
    given = {"kind": "ramp", "velocity_mm_per_s": 0.1, "duration_s": 2.0}
    own = {"mass_kg": 1.0, "spring_N_per_mm": 10.0, "normal_force_N": 10.0, "contact": "ground"}
    own |= {"bristle_stiffness_N_per_mm": stiffness / 1e3, "bristle_damping_N_s_per_m": 200.0}
    ds = run(given, own, friction={"dynamic": 0.3, "static": 0.3}, law="lugre")
    # The spring (1e4 N/m) and the bristles share the motion of the base, 0.2 mm in the end.
    tension = 1e4 * (2e-4 - ds["displacement"][-1].item())
    assert ds["displacement"][-1].item() < 2e-4 * 1e4 / stiffness * 1.5
    assert 0.0 < tension < 3.0


def test_bristles_need_the_law_and_a_rest_of_the_record_does_not_have_them():
    own = {"mass": 1.0, "spring": 100.0, "normal_force": 2.0, "bristle_stiffness": 1e4}
    with_bristles = oscillator.record("lugre", 1e-3, 10.0, own)
    without = oscillator.record("coulomb", 1e-3, 10.0, own)
    assert (with_bristles["lugre"]["stiffness"], without["lugre"]["stiffness"]) == (1e4, 0.0)
    assert "lugre" not in oscillator.compact(without).dtype.names
