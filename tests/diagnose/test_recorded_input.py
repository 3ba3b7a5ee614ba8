"""Recorded inputs: what was fed in is simulated, and the noise of its record is part of the covariance."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import chdtrc

from tests.diagnose import synthetic
from tests.diagnose.synthetic import MODEL, base_of
from wedgesweep import config, excitation
from wedgesweep.diagnose.diagnosis import diagnose
from wedgesweep.diagnose.evaluation import Scenario
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.model import Model
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.from_measurement import harmonic_data
from wedgesweep.diagnose.steady.harmonic_data import stated
from wedgesweep.diagnose.steady.recorded_input import without_noise
from wedgesweep.measured.model import with_numbers
from wedgesweep.solvers.periodic import at_rest

LAW = "static-dynamic"
# Half the resonance, and above it; more acceleration than friction can take.
FREQUENCIES, AMPLITUDES = np.array([6.8, 6.8, 11.0, 20.0]), 1e-3 * np.array([1.2, 1.7, 0.3, 0.12])
SECOND, PHASE = 0.01, 0.7
CAUSE = {"guide_friction": {"force": 0.3}}
NOISE = 0.02
DISPLACEMENT = {"displacement": {"column": "d", "unit": "m"}}


def signals(frequency, amplitude, time, effects, numbers):
    """Relative displacement and input (m), exact."""
    omega = 2.0 * np.pi * np.array([frequency])
    rows = simulation.records(
        with_numbers(config.parse(MODEL), numbers), LAW, effects, omega, np.array([amplitude])
    )
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


def measurement(
    seed=0,
    effects=None,
    columns=None,
    quantity="displacement",
    noise=NOISE,
    input_noise=None,
    bench=(FREQUENCIES, AMPLITUDES),
    numbers=None,
):
    """Tests of 10 whole periods with noise on every channel, relative to its rms.

    ``numbers``: of the model in each test.
    """
    rng = np.random.default_rng(seed)
    columns = DISPLACEMENT if columns is None else columns
    records = []
    for i, (f, a) in enumerate(zip(*bench, strict=True)):
        time = np.arange(2000) * 10.0 / f / 2000
        start = rng.uniform(0.0, 1.0 / f)
        own = numbers[i] if numbers else {}
        d, u = signals(f, a, time + start, effects or {}, own)
        channels = {}
        for order, name in enumerate(("displacement", "velocity", "acceleration")):
            if name in columns:
                signal = u - d if columns[name].get("of") == "absolute" else d
                channels[name] = derivative(signal, time, f, order)
            if name == quantity:
                channels["input"] = derivative(u, time, f, order)
        for name, exact in channels.items():
            level = noise if name != "input" or input_noise is None else input_noise
            channels[name] = exact + level * exact.std() * rng.normal(size=exact.size)
        records.append(synthetic.record(f"{i}", f, time, model=own, **channels))
    columns = columns | {"input": {"column": "u", "unit": "m", "quantity": quantity}}
    return synthetic.measurement(config.parse(MODEL), LAW, records, columns)


def misfit(data, effects):
    """Squared misfit under known effects, with the covariance there, and its expectation."""
    scenario = Scenario(effects, stated(data).point)
    compared = data.with_covariance(scenario).compare([scenario], 1e-8)[0]
    return float((compared.residual**2).sum()), int(data.dof.sum())


@pytest.mark.acceptance
@pytest.mark.parametrize("quantity", ["displacement", "acceleration"])
def test_the_misfit_of_the_truth_is_the_noise_of_responses_and_input(quantity):
    """Over seeds: the mean of Q over its degrees of freedom has a standard error of about 2.5 %."""
    ratios, bare = [], []
    for seed in range(6):
        data = harmonic_data(measurement(seed, CAUSE, quantity=quantity))
        q, dof = misfit(data, CAUSE)
        ratios.append(q / dof)
        scenario = Scenario(CAUSE, stated(data).point)
        bare.append((np.array(data.bare().compare([scenario], 1e-8)[0].residual) ** 2).sum() / dof)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.075)
    assert np.mean(bare) > 1.1  # so that the noise of the input does matter


@pytest.mark.few(1)
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


def test_effects_of_sensors_are_candidates_where_the_sensor_is_compared_as_it_is():
    """Beside a velocity that stands for the displacement, what is compared as velocity is an acceleration."""

    def shown(*names, **more):
        columns = {name: {"column": name[0], "unit": "m"} | more for name in names}
        return harmonic_data(measurement(columns=columns)).candidates(["displacement_gain", "velocity_lag"])

    assert shown("displacement", "velocity") == ("displacement_gain", "velocity_lag")
    assert shown("velocity", "acceleration") == ()
    assert shown("displacement", of="absolute") == ()


def test_a_harmonic_within_its_noise_is_left_out():
    """A doubtful one counts as an error of its own size; the fundamental is always there."""
    measured = np.array([0.01, 0.3, 0.02 + 0.02j, 0.015])
    kept, variance = without_noise(measured, np.full(4, 1e-4))
    np.testing.assert_allclose(kept, [0.01, 0.3, 0.0, 0.0], rtol=0.01)
    np.testing.assert_allclose(variance, [1e-4, 1e-4, 8e-4, 0.0], rtol=0.01)


def test_of_noise_alone_hardly_any_measurement_shows_a_harmonic():
    """A measurement of 12 tests with 15 harmonics besides the fundamental each."""
    rng, tests = np.random.default_rng(0), 12 * 500
    parts = rng.normal(size=(2, tests, 16)) / np.sqrt(2.0)
    shown = [np.count_nonzero(without_noise(each, np.ones(16))[0][1:]) for each in parts[0] + 1j * parts[1]]
    assert np.sum(shown) <= 5


@pytest.mark.acceptance
def test_noise_of_the_input_is_no_harmonic_where_friction_nearly_holds():
    """There a harmonic of high order, which brings much acceleration, would change the response."""
    bench = np.repeat([6.8, 8.0], 4), 1e-3 * np.array([0.6, 0.7, 0.8, 0.9, 0.25, 0.3, 0.35, 0.4])
    ratios = []
    for seed in range(5):
        q, dof = misfit(harmonic_data(measurement(seed, noise=0.01, bench=bench)), {})
        ratios.append(q / dof)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.1)


@pytest.mark.acceptance
def test_the_cause_is_named_and_the_distortion_is_not_blamed():
    found = diagnose(measurement(1, CAUSE), ("guide_friction", "friction_level", "input_distortion"))
    assert found.finding.verdict in ("named", "consistent-with")
    assert found.finding.best.effects == ("guide_friction",)
    value = found.finding.best.values["guide_friction"]["force_N"]
    assert value == pytest.approx(0.3, rel=0.1)


@pytest.mark.acceptance
def test_without_a_cause_nothing_is_missing_though_the_input_is_distorted():
    found = diagnose(measurement(2), ("guide_friction", "input_distortion", "stribeck"))
    assert found.finding.verdict == "nothing-missing"


# Tests at the resonance of the true rig, above that of the stated one; the record of the input is noisy.
STIFF = {"bolster_stiffness": {"scale": 1.9}}
AT_ITS_RESONANCE = (np.array([17.5, 18.0, 18.5, 19.0, 20.0]), 1e-3 * np.array([0.18, 0.18, 0.16, 0.16, 0.14]))


def stiff(seed):
    return measurement(seed, STIFF, noise=0.004, input_noise=0.08, bench=AT_ITS_RESONANCE)


@pytest.mark.acceptance
def test_the_noise_of_the_input_counts_as_the_right_model_passes_it_on():
    """With the covariance of the stated model the truth itself would be rejected."""
    before, after = [], []
    for seed in range(5):
        data = harmonic_data(stiff(seed))
        truth = Scenario(STIFF, stated(data).point)
        for found, each in ((before, data), (after, data.renewed(truth))):
            q = (each.compare([truth], 1e-8)[0].residual ** 2).sum()
            found.append(float(chdtrc(data.dof.sum(), q)))
    assert np.median(before) < 1e-3
    assert np.median(after) > 0.1


@pytest.mark.acceptance
def test_a_diagnosis_ends_with_the_covariance_of_its_cause():
    found = diagnose(stiff(1), ("bolster_stiffness", "viscous_damping"))
    assert found.finding.verdict in ("named", "consistent-with")
    assert found.finding.best.effects == ("bolster_stiffness",)
    fit = found.finding.best
    assert found.data.renewed(fit.model.scenario(fit.point)) is found.data
    assert fit.model.data is found.data


@pytest.mark.few(1)
@pytest.mark.parametrize("of", ["absolute", "relative"])
def test_one_gain_of_the_input_serves_all_tests(of):
    """The recorded input is 3 % too small in all tests; channels that it converts are wrong as well."""
    columns = {"displacement": {"column": "d", "unit": "m", "of": of}}
    true = measurement(3, CAUSE, columns, noise=0.005)
    tests = tuple(replace(each, input=each.input / 1.03) for each in true.tests)
    wrong, uncertain = (replace(true, tests=tests, input_gain_std=std) for std in (0.0, 0.05))
    known = config.parse(MODEL + "[effects.guide_friction]\nforce_N = 0.3\n")
    blamed, fit = (base_of(harmonic_data(replace(each, model=known))) for each in (wrong, uncertain))
    assert blamed.p < 1e-6
    assert fit.p > 0.01
    gain, std = fit.x[0], np.sqrt(fit.covariance[0, 0])
    assert gain == pytest.approx(1.03, abs=4.0 * std)
    assert std < 0.01
    fitted = fit.model.data.inputs_of(fit.model.scenario(fit.point))
    np.testing.assert_allclose(fitted, AMPLITUDES, rtol=0.02)


@pytest.mark.acceptance
def test_noise_that_input_and_response_share_counts_with_its_sign():
    """One noise in both channels, as from a common supply."""
    rng, ratios = np.random.default_rng(0), []
    for seed in range(6):
        own = measurement(seed, CAUSE, noise=0.01)
        tests = []
        for each in own.tests:
            common = 0.02 * rng.normal(size=each.time.size)
            shown = each.displacement - common * each.displacement.std()
            tests.append(replace(each, displacement=shown, input=each.input + common * each.input.std()))
        q, dof = misfit(harmonic_data(replace(own, tests=tuple(tests))), CAUSE)
        ratios.append(q / dof)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.1)


def test_a_model_error_has_no_part_in_the_noise_that_input_and_response_share():
    data = harmonic_data(measurement(0, CAUSE, noise=0.005))
    shared = np.full_like(data.inputs.shared, 0.9)
    data = replace(data, inputs=data.inputs._replace(shared=shared))
    direct = data.with_model_error(0.02).with_covariance(stated(data))
    later = data.with_covariance(stated(data)).with_model_error(0.02)
    by_input = [np.linalg.inv(each.whitening @ each.whitening) - np.eye(32) for each in (direct, later)]
    assert np.linalg.norm(by_input[0] - by_input[1]) < 0.01 * np.linalg.norm(by_input[1])


def test_bootstrap_samples_have_the_noise_of_responses_and_inputs():
    """And what both share: residuals of samples at the truth are of unit covariance again."""
    data = harmonic_data(measurement(0, CAUSE, noise=0.005, input_noise=0.05))
    shared = np.full_like(data.inputs.shared, 0.6 + 0.3j)
    data = replace(data, inputs=data.inputs._replace(shared=shared)).with_covariance(stated(data))
    truth = Model(data, Hypothesis(())).evaluate(stated(data).point)
    rng, squares = np.random.default_rng(5), []
    for _ in range(200):
        sample = data.bootstrap_sample(truth, rng)
        assert (sample.inputs.displacement == data.inputs.displacement).all()
        squares.append(sample.compared_again(truth).chi2)
    expected = data.observations.sum()
    assert np.mean(squares) == pytest.approx(expected, abs=4.0 * np.sqrt(2.0 * expected / 200))
    assert np.std(squares) == pytest.approx(np.sqrt(2.0 * expected), rel=0.25)


@pytest.mark.acceptance
def test_numbers_of_single_tests_are_part_of_the_model():
    """A heavier bolster in every other test: known, it is not missing, and the same cause is found in all."""
    heavier = [{}, {"suspension.bolster_mass_kg": 0.9}] * 2
    given = measurement(3, CAUSE, numbers=heavier)
    found = diagnose(given, ("guide_friction", "bolster_mass"))
    assert found.finding.best.effects == ("guide_friction",)
    assert found.finding.verdict in ("named", "consistent-with")
    unknown = replace(given, tests=tuple(replace(test, model={}) for test in given.tests))
    scenario = Scenario(CAUSE, found.finding.best.point)
    q = [(harmonic_data(each).compare([scenario], 1e-6)[0].residual ** 2).sum() for each in (given, unknown)]
    assert 100.0 * q[0] < q[1]
