"""Synthetic measurements: what is hidden comes out again, and nothing else is in them."""

import json
from math import inf, pi

import numpy as np
import pytest

from tests.command import invoke
from tests.diagnose.test_transients import OSCILLATOR
from tests.fixture_measured import MEASURED, write
from wedgesweep import config, measured
from wedgesweep.measured.cycles import estimate_noise
from wedgesweep.solvers import event_driven
from wedgesweep.solvers.trajectory import Window
from wedgesweep.synthesize.motion import Clock, steady
from wedgesweep.synthesize.noise import NOISES as BY_NAME
from wedgesweep.synthesize.options import NOISES
from wedgesweep.systems.suspension import parameters

TRUE = """\
title = "true"
[suspension]
bolster_mass_kg = 0.71
[effects.guide_friction]
force_N = 0.8
[sweep]
friction_law = "static-dynamic"
beta = 1.0
amplitude_mm = 0.1
"""
TESTS = """\
[[test]]
frequency_hz = 20.0
amplitude_mm = 0.11
[[test]]
frequency_hz = 28.0
amplitude_mm = 0.1
amplitude_std = 0.05
known = false
"""

# Records of tests that need neither a steady motion nor a long one.
SHORT = ("--settle-periods", 3, "--periods", 4)
# So many that a straight line between them is right to 1e-6 of the signal.
SAMPLES = 2**17


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "true.toml").write_text(TRUE)
    (tmp_path / "tests.toml").write_text(TESTS)
    return tmp_path


def synthesize(*more, output="made", code=0):
    return invoke(
        *("synthesize", "true.toml", "--tests", "tests.toml", "--n-jobs", 1, "-o", output), *more, code=code
    )


def truth(here, output="made"):
    return json.loads((here / output / "truth.json").read_text())


def contents(directory):
    return {path.name: path.read_bytes() for path in directory.iterdir()}


def test_round_trip(here):
    told = synthesize("--seed", 3)
    assert told.endswith("wrote made/measured.toml: 2 tests\n")
    assert "not steady" not in told
    assert sorted(contents(here / "made")) == [
        *("measured.toml", "model.toml", "test-00.csv", "test-01.csv", "truth.json")
    ]
    found, hidden = measured.read(here / "made" / "measured.toml"), truth(here)
    assert found.law == hidden["friction_law"] == "static-dynamic"
    assert hidden["effects"] == {"guide_friction": {"force_N": 0.8}}
    # The base model is the true one but for what is hidden.
    true = config.load(here / "true.toml")
    assert found.model.effects == {}
    assert found.model.suspension == true.suspension
    assert found.model.sweep.omega_n == true.sweep.omega_n
    known, unknown = found.tests
    assert (known.frequency, known.amplitude, known.amplitude_std) == (20.0, pytest.approx(1.1e-4), 1e-3)
    assert (unknown.amplitude, unknown.amplitude_std) == (None, 0.0)
    for test, hidden_test in zip(found.tests, hidden["tests"], strict=True):
        assert test.sampling_rate == pytest.approx(hidden_test["sampling_hz"], rel=1e-5)
        assert test.duration * test.frequency == pytest.approx(8.4, abs=0.02)
        per_period = test.sampling_rate / test.frequency
        assert abs(per_period - round(per_period)) > 1e-3
        for channel in (test.displacement, test.velocity):
            assert estimate_noise(test.time, channel, test.frequency).share == pytest.approx(0.04, rel=0.15)
    errors = [each["amplitude_mm"] / each["nominal_amplitude_mm"] - 1.0 for each in hidden["tests"]]
    assert 0.0 < abs(errors[0]) < 5e-3
    assert 0.0 < abs(errors[1]) < 0.25
    told = invoke("check", "made/measured.toml")
    for words in (
        "made/measured.toml: valid",
        "model: model on trial, static-dynamic",
        "tests: 2",
        "unknown",
    ):
        assert words in told


@pytest.mark.parametrize("n_jobs", [1, pytest.param(2, marks=pytest.mark.acceptance)])
def test_a_seed_decides_everything(here, n_jobs):
    for output, seed in (("a", 1), ("b", 1), ("c", 2)):
        synthesize("--seed", seed, "--n-jobs", n_jobs if output == "b" else 1, *SHORT, output=output)
    a, b, c = (contents(here / name) for name in "abc")
    a["measured.toml"] = a["measured.toml"].replace(b'"a"', b'"b"')  # the title
    assert a == b
    assert a["test-00.csv"] != c["test-00.csv"]


@pytest.mark.few(1)
@pytest.mark.parametrize("law", ["coulomb", "static-dynamic", "exponential"])
def test_without_noise_it_is_the_other_solvers_motion(here, law):
    """Amplitude, phase, sampling and settling, against the event-driven solver."""
    (here / "true.toml").write_text(TRUE.replace("static-dynamic", law))
    synthesize("--level", 0, "--seed", 4)
    found, hidden = measured.read(here / "made" / "measured.toml"), truth(here)
    true = config.load(here / "true.toml")
    for test, hidden_test in zip(found.tests, hidden["tests"], strict=True):
        omega = 2.0 * pi * test.frequency
        record = parameters.record(
            *(law, hidden_test["amplitude_mm"] * 1e-3, omega),
            *(true.suspension, true.friction, true.effects),
        )
        window = Window(omega, 150, 1, SAMPLES)
        samples = event_driven.solve(record, window, 1e-10, inf).samples
        phase = omega * test.time + np.radians(hidden_test["phase_deg"])
        grid = np.linspace(0.0, 2.0 * pi, SAMPLES, endpoint=False)
        for channel, expected in ((test.displacement, -samples.x), (test.velocity, -samples.velocity)):
            there = np.interp(phase, grid, expected, period=2.0 * pi)
            left = channel - there
            assert np.std(left) < 1e-5 * np.std(there)


@pytest.mark.parametrize("kind", NOISES)
def test_noise_has_its_level_and_colour(kind):
    random = np.random.default_rng(2)
    step = 1.0 / 1987.3
    t = step * np.arange(20_000)
    clean = (1e-3 * np.sin(40.0 * pi * t), 4e-2 * pi * np.cos(40.0 * pi * t))
    displacement, velocity = BY_NAME[kind](clean, 0.04, step, random)
    cut = slice(1, -1) if kind == "differentiated" else slice(None)
    left = [noisy - each[cut] for noisy, each in zip((displacement, velocity), clean, strict=True)]
    shares = [each.std() / channel.std() for each, channel in zip(left, clean, strict=True)]
    correlations = [np.corrcoef(each[1:], each[:-1])[0, 1] for each in left]
    expected = {"ar1": 0.9}.get(kind, 0.0)
    if kind == "differentiated":
        # Differences over two samples: neighbours share none, so that every other one is correlated.
        assert shares[0] == pytest.approx(0.04, rel=0.05)
        assert left[1].std() == pytest.approx(left[0].std() / (np.sqrt(2.0) * step), rel=0.05)
        assert np.corrcoef(left[1][2:], left[1][:-2])[0, 1] == pytest.approx(-0.5, abs=0.05)
        return
    assert shares == pytest.approx([0.02 if kind == "adc" else 0.04] * 2, rel=0.1)
    assert correlations == pytest.approx([expected] * 2, abs=0.05)
    assert (np.unique(displacement).size <= 4096) == (kind == "adc")
    if kind == "white":  # and independent of the other channel
        assert abs(np.corrcoef(*left)[0, 1]) < 0.03


def test_a_derived_velocity_is_said_to_be_one(here):
    synthesize("--noise", "differentiated", *SHORT)
    found = measured.read(here / "made" / "measured.toml")
    assert found.derived_velocity
    test = found.tests[0]
    differences = (test.displacement[2:] - test.displacement[:-2]) * test.sampling_rate / 2.0
    # As far as the file's decimals go.
    np.testing.assert_allclose(test.velocity[1:-1], differences, atol=1e-4 * np.abs(differences).max())


def test_the_lag_of_the_velocity_is_first_order():
    """Each harmonic of the lagged velocity against its closed form 1 / (1 + i h omega tau)."""
    omega, lag = 2.0 * pi * 20.0, 3e-3
    record = parameters.record("static-dynamic", 1.1e-4, omega, effects={"guide_friction": {"force": 0.8}})
    clock = Clock(0.011, 1.0 / 4000.0, 1600)  # 8 whole periods
    plain = steady(record, clock, 60, True, {})
    lagged = steady(record, clock, 60, True, {"velocity_lag": {"time": lag}})
    np.testing.assert_allclose(lagged.displacement, plain.displacement, rtol=0.0, atol=1e-6 * 1.1e-4)
    before, after = np.fft.rfft(plain.velocity), np.fft.rfft(lagged.velocity)
    for h in (1, 2, 3):
        expected = before[8 * h] / (1.0 + 1j * h * omega * lag)
        assert abs(after[8 * h] - expected) < 1e-5 * abs(before[8])


def test_the_gain_of_the_displacement():
    record = parameters.record("static-dynamic", 1.1e-4, 2.0 * pi * 20.0)
    clock = Clock(0.0, 1.0 / 1000.0, 200)
    plain = steady(record, clock, 10, True, {})
    scaled = steady(record, clock, 10, True, {"displacement_gain": {"scale": 0.9}})
    np.testing.assert_allclose(scaled.displacement, 0.9 * plain.displacement, rtol=1e-12)
    assert np.array_equal(scaled.velocity, plain.velocity)


def test_an_uncertain_number_is_off_and_told(here):
    (here / "tests.toml").write_text(f"[uncertain]\nfriction_level = 0.1\n{TESTS}")
    synthesize("--level", 0, *SHORT)
    factor = truth(here)["uncertain"]["friction_level"]
    assert 0.0 < abs(factor - 1.0) < 0.5
    assert measured.read(here / "made" / "measured.toml").uncertain == {"friction_level": 0.1}
    # The same data from a system whose friction is that much off, and certain.
    more = f"[effects.friction_level]\nscale = {factor!r}\n"
    (here / "true.toml").write_text(TRUE.replace("[sweep]", f"{more}[sweep]"))
    (here / "tests.toml").write_text(TESTS)
    synthesize("--level", 0, *SHORT, output="certain")
    for name in ("test-00.csv", "test-01.csv"):
        assert contents(here / "made")[name] == contents(here / "certain")[name]


@pytest.mark.acceptance
def test_an_uncertain_distortion_is_the_same_in_all_tests_and_told(here):
    # An oscillator: its code for such inputs is shared with tests of releases.
    tests = TESTS.replace("20.0", "3.0").replace("28.0", "4.0").replace("0.1", "4.0")
    (here / "true.toml").write_text(OSCILLATOR)
    (here / "tests.toml").write_text(f"[uncertain]\ninput_distortion = 0.01\n{tests}")
    synthesize("--level", 0, *SHORT)
    told = truth(here)["uncertain"]["input_distortion"]
    assert 0.0 < told["second"] < 0.05
    assert told["second"] != told["third"]
    assert measured.read(here / "made" / "measured.toml").uncertain == {"input_distortion": 0.01}
    more = "[effects.input_distortion]\n" + "".join(f"{key} = {value!r}\n" for key, value in told.items())
    (here / "true.toml").write_text(OSCILLATOR.replace("[sweep]", f"{more}[sweep]"))
    (here / "tests.toml").write_text(tests)
    synthesize("--level", 0, *SHORT, output="certain")
    for name in ("test-00.csv", "test-01.csv"):
        drawn, certain = (
            np.loadtxt(here / each / name, delimiter=",", skiprows=1) for each in ("made", "certain")
        )
        # The phases have gone through degrees.
        np.testing.assert_allclose(drawn, certain, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize(
    ("file", "old", "new", "words"),
    [
        ("true.toml", '"static-dynamic"', '["coulomb", "exponential"]', "sweep.friction_law: coulomb"),
        ("true.toml", "force_N", "forse_N", 'forse_N: unknown key; did you mean "force_N"'),
        ("tests.toml", "known = false", "known = 0", "test[1].known: 0 is neither true nor false"),
        ("tests.toml", "0.11", "-0.11", "tests.toml: test[0].amplitude_mm: -0.11 is out of range"),
        ("tests.toml", TESTS, "", "tests.toml: test: missing; write [[test]] for each"),
        ("tests.toml", "[[test]]", "[test", "tests.toml: not valid TOML"),
        ("tests.toml", "[[test]]", "# \udcff\n[[test]]", "tests.toml: not UTF-8 text (byte 2)"),
    ],
)
def test_faults_write_nothing(here, file, old, new, words):
    text = (here / file).read_text()
    assert old in text
    (here / file).write_text(text.replace(old, new, 1), encoding="utf-8", errors="surrogateescape")
    assert words in synthesize(code=2)
    assert sorted(path.name for path in here.iterdir()) == ["tests.toml", "true.toml"]


def test_records_of_a_length_that_none_has_and_places_that_hold_something(here):
    for option, value, message in (
        ("--periods", 1e9, "e+11 samples, at most 5000000 fit into memory; sample less often"),
        ("--sampling-hz", 60.0, "3 samples per period, at least 5 are needed; raise --sampling-hz"),
    ):
        assert message in synthesize(option, value, code=2)
    assert not (here / "made").exists()
    (here / "made").mkdir()
    (here / "made" / "mine").write_text("mine")
    assert "made: not an empty directory" in synthesize(code=2)
    assert contents(here / "made") == {"mine": b"mine"}
    assert "absent: not a directory" in synthesize(output="absent/made", code=2)


@pytest.mark.acceptance
def test_a_foreign_tone_has_a_phase_of_its_own_in_each_test(here):
    tone = "[effects.stray_vibration]\nacceleration_m_per_s2 = 0.4\nfrequency_hz = 47.0\n"
    (here / "true.toml").write_text(TRUE.replace("[sweep]", f"{tone}[sweep]"))
    synthesize("--level", 0, "--settle-periods", 6)
    phases = [each["stray_vibration_phase_deg"] for each in truth(here)["tests"]]
    assert 0.0 <= min(phases) < max(phases) < 360.0
    # It is in the data: a line between the harmonics of the input.
    test = measured.read(here / "made" / "measured.toml").tests[0]
    t = test.time
    there, beside = (
        abs(np.exp(-2j * pi * f * t) @ (np.hanning(t.size) * test.velocity)) for f in (47.0, 53.0)
    )
    assert there > 3.0 * beside


def test_what_is_not_steady_is_told(here):
    (here / "tests.toml").write_text(TESTS[: TESTS.rindex("[[test]]")])
    told = synthesize("--settle-periods", 2, "--periods", 4)
    assert "test[0] (20 Hz, 0.11 mm): not steady after 2 periods; raise --settle-periods" in told


def test_tests_that_cannot_be_simulated_write_nothing(here):
    locks = "[friction]\ndynamic = 0.5\nstatic = 0.5\n[effects"
    text = TRUE.replace("[effects", locks).replace("bolster_mass_kg = 0.71", "column_angle_deg = -4.0")
    (here / "true.toml").write_text(text)
    (here / "tests.toml").write_text(TESTS.replace("0.11", "5.0").replace("20.0", "15.0"))
    told = synthesize(code=2)
    assert "test[0] (15 Hz, 5 mm): normal forces not unique" in told
    (here / "true.toml").write_text(TRUE.replace("static-dynamic", "coulomb"))
    (here / "tests.toml").write_text(TESTS.replace("0.11", "0.001"))
    told = synthesize(code=2)
    assert "test[0] (20 Hz, 0.001 mm): the mass sticks all the time" in told
    assert "test[1]" not in told
    assert sorted(path.name for path in here.iterdir()) == ["tests.toml", "true.toml"]


def test_check_lists_what_was_measured(tmp_path):
    text = MEASURED.replace("frequency_hz = 20.0\n", "")
    text = text.replace("[[", "[measurement.uncertain]\nfriction_level = 0.1\n[[", 1)
    told = invoke("check", write(tmp_path, text))
    for words in ("title: bench", "model: on trial, static-dynamic", "uncertain: friction_level, 10 %"):
        assert words in told
    row = next(line for line in told.splitlines() if line.startswith("one.csv"))
    for words in ("(estimated)", "0.3 +- 1 %", "10.30", "mm (2.", "mm/s (", "1, 3"):
        assert words in row
