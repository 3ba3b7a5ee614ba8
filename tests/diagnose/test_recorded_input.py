"""Recorded inputs: what was fed in is simulated, and the noise of its record is part of the covariance."""

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL
from wedgesweep import config, excitation
from wedgesweep.diagnose.diagnosis import diagnose
from wedgesweep.diagnose.fit_data import Scenario
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.from_measurement import harmonic_data
from wedgesweep.diagnose.steady.recorded_input import stated, without_noise
from wedgesweep.measured.measurement import Measurement, TestRecord
from wedgesweep.solvers.periodic import at_rest

LAW = "static-dynamic"
# Half the resonance, and above it; more acceleration than friction can take.
FREQUENCIES, AMPLITUDES = np.array([6.8, 6.8, 11.0, 20.0]), 1e-3 * np.array([1.2, 1.7, 0.3, 0.12])
SECOND, PHASE = 0.01, 0.7
CAUSE = {"viscous_damping": {"coefficient": 3.0}}
NOISE = 0.02
DISPLACEMENT = {"displacement": {"column": "d", "unit": "m"}}


def signals(frequency, amplitude, time, effects):
    """Relative displacement and input (m), exact."""
    omega = 2.0 * np.pi * np.array([frequency])
    rows = simulation.records(config.parse(MODEL), LAW, effects, omega, np.array([amplitude]))
    shape = -1j * np.array([1.0, SECOND * np.exp(1j * PHASE)])
    excitation.set_series(rows, shape)
    found = simulation.respond(rows, at_rest(1), simulation.SIMULATED, 1e-9).harmonics[0, 0]
    turns = np.exp(1j * omega * np.outer(np.arange(1, found.size + 1), time).T)
    return (turns @ found).real, amplitude * (turns[:, :2] @ shape).real


def derivative(signal, time, frequency, order):
    """Derivative of a periodic signal of whole periods."""
    spectrum = np.fft.rfft(signal)
    omega = 2.0 * np.pi * np.fft.rfftfreq(signal.size, time[1] - time[0])
    return np.fft.irfft(spectrum * (1j * omega) ** order, signal.size)


def measurement(seed=0, effects=None, columns=None, quantity="displacement", noise=NOISE, tests=slice(None)):
    """Tests of 10 whole periods with noise on every channel, relative to its rms."""
    rng = np.random.default_rng(seed)
    columns = DISPLACEMENT if columns is None else columns
    records = []
    for i, (f, a) in enumerate(zip(FREQUENCIES[tests], AMPLITUDES[tests], strict=True)):
        time = np.arange(2000) * 10.0 / f / 2000
        start = rng.uniform(0.0, 1.0 / f)
        d, u = signals(f, a, time + start, effects or {})
        channels = {}
        for order, name in enumerate(("displacement", "velocity", "acceleration")):
            if name in columns:
                signal = u - d if columns[name].get("of") == "absolute" else d
                channels[name] = derivative(signal, time, f, order)
            if name == quantity:
                channels["input"] = derivative(u, time, f, order)
        for name, exact in channels.items():
            channels[name] = exact + noise * exact.std() * rng.normal(size=exact.size)
        empty = {"displacement": None, "velocity": None}
        records.append(
            TestRecord(
                name=f"{i}",
                file=f"{i}.csv",
                frequency=f,
                amplitude=None,
                amplitude_std=0.0,
                time=time,
                **(empty | channels),
            )
        )
    return Measurement(
        path=None,
        title="bench",
        model=config.parse(MODEL),
        law=LAW,
        uncertain={},
        tests=tuple(records),
        derived_velocity=False,
        columns=columns | {"input": {"column": "u", "unit": "m", "quantity": quantity}},
    )


def misfit(data, effects):
    """Squared misfit under known effects, with the covariance there, and its expectation."""
    scenario = Scenario(effects, stated(data).point)
    compared = data.with_covariance(scenario).compare([scenario], 1e-8)[0]
    return float((compared.residual**2).sum()), int(data.dof.sum())


@pytest.mark.parametrize("quantity", ["displacement", "acceleration"])
def test_the_misfit_of_the_truth_is_the_noise_of_responses_and_input(quantity):
    """Over seeds: the mean of Q over its degrees of freedom has a standard error of about 2 %."""
    ratios, bare = [], []
    for seed in range(10):
        data = harmonic_data(measurement(seed, CAUSE, quantity=quantity))
        q, dof = misfit(data, CAUSE)
        ratios.append(q / dof)
        scenario = Scenario(CAUSE, stated(data).point)
        bare.append((np.array(data.bare().compare([scenario], 1e-8)[0].residual) ** 2).sum() / dof)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.06)
    assert np.mean(bare) > 1.1  # so that the noise of the input does matter


@pytest.mark.parametrize(
    "columns",
    [
        {"displacement": {"of": "absolute"}},
        {"acceleration": {"of": "absolute"}},
        {"velocity": {"of": "relative"}},
        {"displacement": {"of": "relative"}, "acceleration": {"of": "absolute"}},
    ],
    ids=["absolute", "absolute acceleration", "velocity", "two channels"],
)
def test_every_channel_tells_the_same_motion(columns):
    columns = {name: each | {"column": name, "unit": "m"} for name, each in columns.items()}
    ratios = []
    for seed in range(4):
        data = harmonic_data(measurement(seed, CAUSE, columns, noise=0.005))
        q, dof = misfit(data, CAUSE)
        ratios.append(q / dof)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.12)


def test_a_harmonic_within_its_noise_is_left_out():
    measured = np.array([1.0, 0.3, 0.01 + 0.005j])
    kept, variance = without_noise(measured, np.full(3, 1e-4))
    assert kept[0] == 1.0
    assert kept[1] == pytest.approx(0.3, rel=0.01)
    assert kept[2] == 0.0
    assert variance[2] == 0.0


def test_the_cause_is_named_and_the_distortion_is_not_blamed():
    found = diagnose(
        measurement(1, CAUSE), ("viscous_damping", "input_distortion", "stribeck", "bolster_mass")
    )
    assert found.finding.verdict in ("named", "consistent-with")
    assert found.finding.best.effects == ("viscous_damping",)
    value = found.finding.best.fit.values["viscous_damping"]["coefficient_N_s_per_m"]
    assert value == pytest.approx(3.0, rel=0.1)


def test_without_a_cause_nothing_is_missing_though_the_input_is_distorted():
    found = diagnose(measurement(2), ("viscous_damping", "input_distortion", "stribeck"))
    assert found.finding.verdict == "nothing-missing"
