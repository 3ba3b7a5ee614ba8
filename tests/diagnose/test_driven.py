"""Transients under a recorded input: sweeps, bumps and random motion of the base, or a force."""

import numpy as np
import pytest

from tests.diagnose.answers import diagnosed, is_told
from tests.diagnose.rigs import HEAD, PLACE, TRANSIENT, saved
from tests.diagnose.test_transients import OSCILLATOR, WEDGE
from wedgesweep.config import parse
from wedgesweep.diagnose.search import Search, base_fit, single_fit
from wedgesweep.diagnose.transient.from_measurement import transient_data
from wedgesweep.diagnose.transient.recorded_input import RecordedInput
from wedgesweep.effects import merge
from wedgesweep.measured import MeasuredError, read
from wedgesweep.sampled_input import from_samples, set_sampled
from wedgesweep.solvers import periodic
from wedgesweep.systems import state_count

RATE, SAMPLES, FINE = 250.0, 2500, 4
TIMES = np.arange(SAMPLES * FINE) / (RATE * FINE)
UNITS = {"displacement": ("mm", 1e-3), "acceleration": ("m/s^2", 1.0), "force": ("N", 1.0)}


def chirp(low=1.0, high=6.0):
    """A swept sine (n,), from low to high frequency (Hz)."""
    return np.sin(2.0 * np.pi * (low * TIMES + (high - low) * TIMES**2 / (2.0 * TIMES[-1])))


def rough(seed, highest=8.0):
    """Random motion (n,) of unit variance up to some frequency (Hz)."""
    frequency = np.fft.rfftfreq(TIMES.size, TIMES[1])
    rng = np.random.default_rng(seed)
    spectrum = (frequency < highest) * np.exp(2j * np.pi * rng.random(frequency.size))
    found = np.fft.irfft(spectrum, TIMES.size)
    return found / found.std()


def bump(at=1.0, length=0.4):
    """One half sine (n,)."""
    inside = (at < TIMES) & (at + length > TIMES)
    return np.where(inside, np.sin(np.pi * (TIMES - at) / length) ** 2, 0.0)


def response(config, effects, given, quantity):
    """Displacement and velocity (m, m/s), shape (2, n), as sensors show them, from rest."""
    sampled = from_samples(given, float(TIMES[1]), quantity)
    record = config.record_with(merge(config.effects, effects), config.case_list()[0].law, 1.0, 16.0)
    set_sampled(record, sampled, 0.01 if quantity != "force" else 5.0, 16.0, SAMPLES / RATE)
    found = periodic.sampled(record, np.zeros((1, state_count())), 0, 1, SAMPLES * FINE, 1e-10)
    return -np.array([found[0][0], found[1][0]])


def write(
    folder, inputs, effects=None, model=OSCILLATOR, quantity="displacement", noise=(1e-4, 1e-3), more=""
):
    """Files of tests under some inputs (n,); returns the path of measured.toml.

    ``noise``: of the displacement (m), and of the input over its standard deviation.
    """
    rng, (unit, size) = np.random.default_rng(1), UNITS[quantity]
    config, tests = parse(model, "model"), {}
    head = HEAD + PLACE + f'input = {{ column = "u", unit = "{unit}", quantity = "{quantity}" }}\n' + more
    for i, given in enumerate(inputs):
        x = response(config, effects or {}, given, quantity)[0, ::FINE]
        x = x + 1e-3 + noise[0] * rng.standard_normal(x.size)
        u = given[::FINE] + noise[1] * given.std() * rng.standard_normal(x.size)
        tests[f"t{i}"] = (TIMES[::FINE], 1e3 * x, u / size), TRANSIENT
    return saved(folder, model, head, "t,x,u", tests)


HIDDEN = {"viscous_damping": {"coefficient": 4.0}}
CANDIDATES = ["viscous_damping", "friction_level", "cubic_stiffness"]
SOFT = {"bolster_stiffness": {"scale": 0.9}}


def test_a_cause_without_mechanics_of_its_own_is_named_under_a_swept_sine(tmp_path):
    found = diagnosed(write(tmp_path, [4e-3 * chirp()], SOFT), [*SOFT, "friction_level"])
    assert found.verdict == "named"
    is_told(found, SOFT, 1e-3)


@pytest.mark.acceptance
def test_a_damper_that_is_too_strong_is_fitted_beside_a_cause_where_it_is_uncertain(tmp_path):
    """The model has 10 % more damping than the rig, as a first estimate from data may have."""
    hidden = {"friction_level": {"scale": 1.3}}
    model = OSCILLATOR.replace("damping_N_s_per_m = 1.0", "damping_N_s_per_m = 5.0")
    more = "[measurement.uncertain]\ndamping_level = 0.1\n"
    path = write(tmp_path, [4e-3 * chirp()], hidden | {"damping_level": {"scale": 0.9}}, model, more=more)
    found = diagnosed(path, [*hidden, "viscous_damping"])
    assert found.verdict == "named"
    is_told(found, hidden, 5e-3)
    assert found.document["uncertain"]["damping_level"]["scale"] == pytest.approx(0.9, abs=0.01)


@pytest.mark.acceptance
def test_a_cause_is_named_under_a_random_motion(tmp_path):
    found = diagnosed(write(tmp_path, [2e-3 * rough(3)], HIDDEN), CANDIDATES[:2])
    assert found.verdict == "named"
    is_told(found, HIDDEN, 0.05)


@pytest.mark.acceptance
def test_nothing_is_missing_where_nothing_is(tmp_path):
    assert diagnosed(write(tmp_path, [4e-3 * chirp()]), CANDIDATES).verdict == "nothing-missing"


@pytest.mark.acceptance
def test_noise_of_the_input_counts_as_the_resonance_passes_it_on(tmp_path):
    model = OSCILLATOR.replace("amplitude_mm = 1.0", 'excitation = "force"\namplitude_N = 1.0')
    model = model.replace("normal_force_N = 1.0", "normal_force_N = 0.0")
    inputs = [amplitude * rough(seed, 6.0) for seed, amplitude in enumerate((1.0, 2.0))]
    stiffening = {"cubic_stiffness": {"coefficient": 2e5}}
    found = diagnosed(write(tmp_path, inputs, stiffening, model, "force", (3e-5, 0.01)), CANDIDATES)
    assert (found.verdict, [each["effect"] for each in found.causes]) == ("named", ["cubic_stiffness"])
    low, high = found.causes[0]["parameters"]["coefficient_N_per_mm3"]["ci95"]
    assert low < 2e-4 < high < 1.01 * low


def test_all_noise_counts_that_acts_with_the_input():
    """Above a sweep's highest frequency the input is nothing but noise, and acts up to the cut-off."""
    noise = 5e-6 * np.random.default_rng(0).standard_normal(SAMPLES)
    given = RecordedInput(4e-3 * chirp(1.0, 4.0)[::FINE] + noise, "displacement", RATE)
    frequency = np.linspace(0.0, 0.5 * RATE, given.noise_power.size)
    for low, high in ((1.0, 4.0), (5.0, 8.0), (10.0, 100.0)):
        power = given.noise_power[(low < frequency) & (frequency < high)].mean()
        assert power == pytest.approx(25e-12, rel=0.2), (low, high)


def test_motion_that_looks_like_noise_is_motion_for_the_most_part():
    white = np.random.default_rng(0).standard_normal(SAMPLES)
    assert RecordedInput(white, "displacement", RATE).noise_power.mean() < 0.003


def test_a_hit_at_the_beginning_of_a_record_tells_the_mass(tmp_path):
    """Before what is compared, any start could take its place; and a Hann window hides it."""
    model = OSCILLATOR.replace("amplitude_mm = 1.0", 'excitation = "force"\namplitude_N = 1.0')
    more = "[measurement.uncertain]\nbolster_mass = 0.1\nbolster_stiffness = 0.1\n"
    hit, lighter = 40.0 * bump(0.1, 0.04), {"bolster_mass": {"scale": 0.93}}
    path = write(tmp_path, [hit], lighter, model, "force", (2e-6, 0.01), more)
    fit = base_fit(Search.of(transient_data(read(path)), [])).base
    assert fit.p > 1e-3
    found = {name: own["scale"] for name, own in fit.model.uncertain.values(fit.x).items()}
    assert found == pytest.approx({"bolster_mass": 0.93, "bolster_stiffness": 1.0}, rel=2e-3)
    assert (np.sqrt(np.diag(fit.covariance)) < 2e-3).all()


@pytest.mark.acceptance
def test_a_gain_error_of_the_input_is_in_a_motion_that_was_converted_with_it(tmp_path):
    """Recorded is the motion against the ground, that against the base and its own; and 3 % less input."""
    path = write(tmp_path, [4e-3 * chirp()], more="[measurement.uncertain]\nbolster_mass = 0.01\n")
    table = np.loadtxt(tmp_path / "t0.csv", delimiter=",", skiprows=1)
    table[:, 1] += table[:, 2]
    table[:, 2] /= 1.03
    np.savetxt(tmp_path / "t0.csv", table, "%.12g", ",", header="t,x,u", comments="")
    text = path.read_text().replace('"x", unit = "mm"', '"x", unit = "mm", of = "absolute"')
    path.write_text(text.replace("[measurement]\n", "[measurement]\ninput_gain_std = 0.05\n", 1))
    data = transient_data(read(path))
    fit = base_fit(Search.of(data, [])).base
    assert fit.p > 1e-4
    gains = np.exp(fit.point.nuisance[:, 2])
    assert gains == pytest.approx(1.03, abs=0.003)
    # What the sensor shows is not what is compared: its own errors cannot be told.
    assert data.candidates(["displacement_gain", "viscous_damping"]) == ("viscous_damping",)


def test_a_test_without_input_says_so(tmp_path):
    path = write(tmp_path, [0.02 * bump()])
    table = np.loadtxt(tmp_path / "t0.csv", delimiter=",", skiprows=1)
    np.savetxt(tmp_path / "t0.csv", table[:, :2], "%.12g", ",", header="t,x", comments="")
    with pytest.raises(MeasuredError, match='no column "u"'):
        read(path)
    path.write_text(path.read_text() + "undriven = true\n")
    assert read(path).tests[0].input is None


@pytest.mark.few(1)
@pytest.mark.parametrize("to_s", [TIMES[-1], 4.0, 2.0])
def test_no_simulation_begins_where_the_filter_of_the_input_has_not_settled(tmp_path, to_s):
    path = write(tmp_path, [4e-3 * chirp(2.0)], noise=(2e-6, 1e-6))
    path.write_text(path.read_text() + f"to_s = {to_s}\n")
    measurement = read(path)
    (test,) = measurement.tests
    settling = RecordedInput(test.input, measurement.recorded_input, test.sampling_rate).settling
    windows = transient_data(measurement).windows
    assert settling > 0
    assert all(round(each.starts_at / each.step) >= settling for each in windows)
    assert all(each.grid.lead > 0 for each in windows)


@pytest.mark.acceptance
def test_bristles_that_were_at_work_before_a_window_are_simulated_from_there(tmp_path):
    # A filter of the input has not settled at either end of a record, which is not compared there.
    path = write(tmp_path, [4e-3 * chirp(2.0)], {"presliding": {"length": 1e-3}}, noise=(2e-6, 1e-6))
    search = Search.of(transient_data(read(path)), ["presliding"])
    assert 0.0 < search.data.windows[0].starts_at < search.data.windows[0].begins
    fit = single_fit(search, "presliding", base_fit(search).base).fit
    assert (fit.evaluation.chi2_by_test < 1.3 * search.data.dof).all()


@pytest.mark.acceptance
def test_what_happens_between_table_and_side_frame_shows_in_the_motion_against_the_side_frame(tmp_path):
    """A recorded input is that of the table; a motion against it is no longer that against the side frame."""
    path = write(tmp_path, [1e-3 * chirp()], noise=(2e-6, 1e-4))
    (tmp_path / "model.toml").write_text(WEDGE)
    effects = ("fixture_resonance", "lift_off", "input_distortion", "stray_vibration", "cross_slip")
    assert transient_data(read(path)).candidates(effects) == ("fixture_resonance", "lift_off")
    path.write_text(path.read_text().replace('"x", unit = "mm"', '"x", unit = "mm", of = "absolute"'))
    assert transient_data(read(path)).candidates(effects) == ("lift_off",)


@pytest.mark.acceptance
def test_wedges_that_lift_off_under_a_recorded_motion(tmp_path):
    hidden = {"lift_off": {"restitution": 0.3}}
    path = write(tmp_path, [2e-3 * rough(3, 20.0)], hidden, WEDGE, noise=(2e-5, 1e-3))
    path.write_text(path.read_text() + "to_s = 2.0\n")
    is_told(diagnosed(path, ["lift_off", "fixture_resonance", "friction_level"]), hidden, 0.02)
