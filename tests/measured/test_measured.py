"""Measured data: what is read is what was written, and every fault is named with its place."""

from math import pi

import numpy as np
import pytest

from tests import fixture_measured
from tests.command import invoke
from tests.fixture_measured import FREQUENCY, MEASURED, MODEL, NOISE, csv_lines, lines, vibration
from wedgesweep import config, measured
from wedgesweep.diagnose.steady.from_measurement import harmonic_data
from wedgesweep.kinds import is_measured
from wedgesweep.measured.channels import model_faults
from wedgesweep.measured.cycles import estimate_noise
from wedgesweep.measured.declarations import PARAMETERS

OF_THE_BENCH = ("bolster_stiffness", "wedge_stiffness", "bolster_mass", "friction_level")


@pytest.fixture
def bench(tmp_path):
    return measured.read(fixture_measured.write(tmp_path))


def problems(path, **more):
    with pytest.raises(measured.MeasuredError) as caught:
        measured.read(path, **more)
    return caught.value.problems


def test_si_units_and_what_is_not_known(tmp_path, bench):
    t, d, v = vibration()
    test = bench.tests[0]
    assert (bench.title, bench.law, bench.model.title) == ("bench", "static-dynamic", "on trial")
    assert (test.name, test.file, test.frequency) == ("one", "one.csv", FREQUENCY)
    assert (test.amplitude, test.amplitude_std) == (pytest.approx(3e-4), 0.01)
    np.testing.assert_allclose(test.time, t, atol=1e-12)
    np.testing.assert_allclose(test.displacement, d * 1e-3, rtol=1e-5)
    np.testing.assert_allclose(test.velocity, v * 1e-3, rtol=1e-5)
    text = MEASURED.split("frequency_hz")[0].replace('velocity = { column = "v", unit = "mm/s" }\n', "")
    (tmp_path / "measured.toml").write_text(text)
    test = measured.read(tmp_path / "measured.toml").tests[0]
    assert (test.frequency, test.amplitude, test.amplitude_std, test.velocity) == (None, None, 0.0, None)


@pytest.mark.parametrize(
    ("units", "factors"),
    [
        (("ms", "um", "m/s"), (1e3, 1e3, 1e-3)),
        (("s", "m", "mm/s"), (1.0, 1e-3, 1.0)),
    ],
)
def test_every_unit_gives_the_same_data(tmp_path, bench, units, factors):
    text = MEASURED.replace('"s"', f'"{units[0]}"')
    text = text.replace('"mm"', f'"{units[1]}"').replace('"mm/s"', f'"{units[2]}"')
    rows = np.column_stack(vibration()) * factors
    csv = ["t,d,v", *(",".join(f"{each:.9g}" for each in row) for row in rows)]
    other = measured.read(fixture_measured.write(tmp_path, text, csv=csv)).tests[0]
    for name in ("time", "displacement", "velocity"):
        np.testing.assert_allclose(getattr(other, name), getattr(bench.tests[0], name), rtol=1e-5, atol=1e-9)


def test_channels_that_nobody_asked_for_may_hold_anything(tmp_path, bench):
    csv = [f'"{i}, fine",{line}' for i, line in enumerate(lines())]
    other = measured.read(fixture_measured.write(tmp_path, csv=csv)).tests[0]
    assert np.array_equal(other.displacement, bench.tests[0].displacement)


def test_a_model_instead_of_the_one_that_is_named(tmp_path):
    path = fixture_measured.write(tmp_path)
    (tmp_path / "other.toml").write_text(MODEL.replace("static-dynamic", "coulomb"))
    assert measured.read(path, tmp_path / "other.toml").law == "coulomb"


def test_the_scales_of_the_parameters_family_can_be_uncertain(tmp_path):
    assert set(PARAMETERS) == {*OF_THE_BENCH, "damping_level"}
    table = "".join(f"{name} = 0.0{i}\n" for i, name in enumerate(OF_THE_BENCH, 1))
    text = MEASURED.replace("[[measurement.test]]", f"[measurement.uncertain]\n{table}[[measurement.test]]")
    found = measured.read(fixture_measured.write(tmp_path, text)).uncertain
    assert found == {name: i / 100.0 for i, name in enumerate(OF_THE_BENCH, 1)}


OSCILLATOR = """
[oscillator]
mass_kg = 1.0
spring_N_per_mm = 1.0
[sweep]
friction_law = "coulomb"
beta = 1.0
amplitude_mm = 1.0
"""


@pytest.mark.parametrize(
    ("model", "lacking"),
    [(MODEL, "damping_level"), (OSCILLATOR, "wedge_stiffness")],
    ids=["suspension", "oscillator"],
)
def test_a_number_that_no_such_model_has_cannot_be_uncertain(tmp_path, model, lacking):
    table = f"[measurement.uncertain]\nbolster_mass = 0.01\n{lacking} = 0.1\n"
    path = fixture_measured.write(
        tmp_path, MEASURED.replace("[[measurement.test]]", f"{table}[[measurement.test]]")
    )
    (tmp_path / "other.toml").write_text(model)
    (fault,) = problems(path, model=tmp_path / "other.toml")
    assert f"measurement.uncertain.{lacking}: is a number of no " in fault


def test_a_model_error_is_allowed_where_it_is_stated(tmp_path, bench):
    assert bench.model_error == 0.0
    text = MEASURED.replace("[measurement]\n", "[measurement]\nmodel_error = 0.015\n", 1)
    found = measured.read(fixture_measured.write(tmp_path, text))
    assert found.model_error == 0.015


def edited(number, edit):
    """The CSV with one line changed; line numbers from 1."""
    csv = lines()
    csv[number - 1 : number] = edit(csv[number - 1].split(","))
    return csv


def joined(edit):
    return lambda cells: [",".join(edit(cells))]


TOML_FAULTS = {
    "not TOML": (("[measurement]", "[measurement"), "measured.toml: not valid TOML: Expected"),
    "near miss": (("frequency_hz", "frequncy_hz"), 'test[0].frequncy_hz: unknown key; did you mean "freq'),
    "unknown table": (
        ("[[measurement.test]]", "[measurement.uncertian]\n[[measurement.test]]"),
        'measurement.uncertian: unknown key; did you mean "uncertain"?',
    ),
    "not a scale": (
        ("[[measurement.test]]", "[measurement.uncertain]\npreload = 0.1\n[[measurement.test]]"),
        "measurement.uncertain.preload: unknown key",
    ),
    "std of 2": (
        ("[[measurement.test]]", "[measurement.uncertain]\nbolster_mass = 2.0\n[[measurement.test]]"),
        "measurement.uncertain.bolster_mass: 2.0 is out of range; it must be less than 1",
    ),
    "model error in per cent": (
        ("[measurement]\n", "[measurement]\nmodel_error = 2.0\n"),
        "measurement.model_error: 2.0 is out of range; it must be less than 1",
    ),
    "harmonics in per cent": (
        ("[measurement]\n", "[measurement]\ninput_harmonics_std = 1.0\n"),
        "measurement.input_harmonics_std: 1.0 is out of range; it must be less than 1",
    ),
    "no model": (('model = "model.toml"\n', ""), 'measurement.model: missing; write model = "model.toml"'),
    "absent model": (
        ("model.toml", "none.toml"),
        "none.toml: No such file or directory; give the path of a config, from here",
    ),
    "no time": (
        ('time = { column = "t", unit = "s" }\n', ""),
        "one.csv: holds no time; write the column time in [measurement.columns], or rate_hz in",
    ),
    "no test": (
        (MEASURED[MEASURED.index("[[") :], ""),
        "measurement.test: missing; write [[measurement.test]] with file",
    ),
    "wrong unit": (
        ('unit = "mm" ', 'unit = "yd" '),
        'displacement.unit: unknown unit "yd"; valid here: m, mm',
    ),
    "unit of another channel": (
        ('unit = "mm/s"', 'unit = "mm"'),
        'velocity.unit: unknown unit "mm"; valid here: m/s',
    ),
    "negative amplitude": (("0.3", "-0.3"), "test[0].amplitude_mm: -0.3 is out of range; it must be greater"),
    "negative std": (
        ("0.01", "-0.01"),
        "test[0].amplitude_std: -0.01 is out of range; it must be at least 0",
    ),
    "std of nothing": (("amplitude_mm = 0.3\n", ""), "test[0].amplitude_std: given without amplitude_mm"),
    "negative frequency": (("20.0", "-20.0"), "test[0].frequency_hz: -20.0 is out of range"),
    "text as frequency": (("20.0", '"20"'), 'test[0].frequency_hz: "20" is not a finite number'),
    "above Nyquist": (("20.0", "600.0"), "one.csv: has 1.67 samples per period of 600 Hz; at least 5 are"),
    "displacement's unit": (
        ('column = "d", unit = "mm"', 'column = "d", unit = "m"'),
        "one.csv: velocity is 0.001 times the rate of displacement at 20 Hz; correct the units",
    ),
    "velocity's unit": (('unit = "mm/s"', 'unit = "m/s"'), "one.csv: velocity is 1e+03 times the rate"),
    "amplitude in m": (
        ("amplitude_mm = 0.3", "amplitude_mm = 0.0003"),
        "one.csv moves 3.34e+03 times its ampl",
    ),
    "too few samples": (("20.0", "300.0"), "one.csv: has 3.33 samples per period of 300 Hz; at least 5 are"),
    "twice the same file": (
        ("[[measurement.test]]", '[[measurement.test]]\nfile = "one.csv"\n[[measurement.test]]'),
        "test[1].file: repeats test[0].file",
    ),
    "absent data": (
        ("one.csv", "two.csv"),
        "two.csv: No such file or directory; give the path of a data file, from here",
    ),
    "unknown column": (('"d"', '"dd"'), 'one.csv:1: no column "dd"; did you mean "d"?'),
    "another frequency": (("20.0", "20.2"), "test[0].frequency_hz: 20.2, but "),
    "a harmonic's frequency": (("20.0", "10.0"), "one.csv vibrates at 20"),
    "far from the frequency": (("20.0", "33.0"), "one.csv vibrates at 20"),
}
CSV_FAULTS = {
    "empty": ([], "one.csv:1: empty; the first line must hold the names"),
    "no header": (
        lines()[1:],
        "one.csv:1: numbers, where the header is expected; write the names of the columns above",
    ),
    "header only": (["t,d,v"], "one.csv: no data below the header"),
    "duplicate header": (
        [f"{line},{'d' if i == 0 else 1}" for i, line in enumerate(lines())],
        'one.csv: column "d" occurs 2 times; write "d#2" for the second',
    ),
    "other separator": ([line.replace(",", "|") for line in lines()], "one.csv:1: only one column"),
    "text": (edited(8, joined(lambda c: [c[0], "n/a", c[2]])), 'one.csv:8: d: "n/a" is not a finite number'),
    "too many cells": (edited(6, joined(lambda c: [*c, "1"])), "one.csv:6: 4 cells; the header has 3"),
    "time back": (
        edited(9, joined(lambda c: ["0.0009", *c[1:]])),
        "one.csv:9: time goes back (0.0009 s follows",
    ),
    "few samples": (lines()[:6], "one.csv:6: ends after 5 samples"),
    "few periods": (lines(periods=3.9), "one.csv: covers 3.9 periods of 20 Hz; at least 4 are needed"),
    "dead channel": (
        [
            ",".join([line.split(",")[0], line.split(",")[1], "1" if i else "v"])
            for i, line in enumerate(lines())
        ],
        "one.csv: velocity is constant",
    ),
    "turned sign": (
        csv_lines(*(sign * each for sign, each in zip((1.0, 1.0, -1.0), vibration(), strict=True))),
        "one.csv: velocity and displacement have opposite signs",
    ),
    "swapped columns": (
        csv_lines(*(vibration()[i] for i in (0, 2, 1))),
        "times the rate of displacement at 20 Hz",
    ),
    "drift": (lines(drift=0.02), "one.csv: the frequency drifts by +2.1 %"),
    "small drift over many periods": (
        lines(periods=300.0, drift=5e-4),
        "one.csv: the frequency drifts by +0.05",
    ),
}


@pytest.mark.parametrize("fault", TOML_FAULTS)
def test_faults_of_the_document(tmp_path, fault):
    (old, new), words = TOML_FAULTS[fault]
    assert old in MEASURED
    found = problems(fixture_measured.write(tmp_path, MEASURED.replace(old, new, 1)))
    assert len(found) == 1, found
    assert words in found[0]
    assert found[0].startswith(str(tmp_path))


def test_where_no_test_moves_the_amplitudes_are_in_another_unit_and_in_one_the_bolster_may_stick(tmp_path):
    text = MEASURED.replace("amplitude_mm = 0.3", "amplitude_mm = 300")
    assert len(measured.read(fixture_measured.write(tmp_path, text)).tests) == 1
    _, again = text.split("[[measurement.test]]")
    (tmp_path / "two.csv").write_bytes((tmp_path / "one.csv").read_bytes())
    text += "[[measurement.test]]" + again.replace("one.csv", "two.csv")
    (found,) = problems(fixture_measured.write(tmp_path, text))
    assert "no test moves more than 0.0033 times its amplitude_mm (one.csv)" in found


@pytest.mark.parametrize("start", [0.4, 0.8, 3.5, 4.0])
def test_a_tone_that_modulates_the_response_is_no_other_frequency(tmp_path, start):
    t, d, v = vibration(periods=8.4)
    noise_alone = d - np.cos(phase := 2.0 * np.pi * FREQUENCY * t + 0.7) - 0.3 * np.sin(3.0 * phase)
    beat = 2.0 * np.pi * 0.8 * t / t[-1] + start
    phase += 0.06 * np.sin(beat)
    d = (1.0 + 0.06 * np.cos(beat)) * (np.cos(phase) + 0.3 * np.sin(3.0 * phase)) + noise_alone
    path = fixture_measured.write(tmp_path, csv=csv_lines(t, d, v))
    assert measured.read(path).tests[0].frequency == FREQUENCY


@pytest.mark.parametrize("fault", CSV_FAULTS)
def test_faults_of_the_data(tmp_path, fault):
    csv, words = CSV_FAULTS[fault]
    found = problems(fixture_measured.write(tmp_path, csv=csv))
    assert len(found) == 1, found
    assert words in found[0]
    assert found[0].startswith(f"{tmp_path}/one.csv")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            '"static-dynamic"',
            '["coulomb", "exponential"]',
            "sweep.friction_law: coulomb, exponential; a model",
        ),
        ("beta", "betta", "model.toml: sweep.betta: unknown key"),
    ],
)
def test_faults_of_the_model(tmp_path, old, new, words):
    found = problems(fixture_measured.write(tmp_path, model=MODEL.replace(old, new)))
    assert words in found[0]
    assert "model.toml" in found[0]


@pytest.mark.parametrize(
    ("old", "key"),
    [("model.toml", "measurement.model"), ("one.csv", "measurement.test[0].file")],
)
def test_a_missing_file_is_told_with_the_key_that_names_it(tmp_path, old, key):
    path = fixture_measured.write(tmp_path, MEASURED.replace(old, "none"))
    assert problems(path)[0].startswith(f"{path}: {key}: {tmp_path}/none: No such file")


def test_all_faults_are_told_at_once(tmp_path):
    text = MEASURED.replace("0.3", "-1.0") + '[[measurement.test]]\nfile = "absent.csv"\n'
    csv = edited(5, joined(lambda c: ["0.0001", *c[1:]]))
    found = "\n".join(problems(fixture_measured.write(tmp_path, text, MODEL.replace("beta", "bta"), csv)))
    for words in ("amplitude_mm: -1.0", "absent.csv: No such file", "one.csv:5: time goes", "sweep.bta"):
        assert words in found


def test_many_faulty_lines_are_counted(tmp_path):
    csv = [line if i < 20 else line.replace(".", "x") for i, line in enumerate(lines())]
    assert "more such faults" in problems(fixture_measured.write(tmp_path, csv=csv))[-1]


def test_a_record_without_vibration_needs_a_frequency(tmp_path):
    random = np.random.default_rng(3)
    csv = [
        "t,d,v",
        *(f"{i / 1000:.4f},{a:.6g},{b:.6g}" for i, (a, b) in enumerate(random.normal(size=(600, 2)))),
    ]
    path = fixture_measured.write(tmp_path, MEASURED.replace("frequency_hz = 20.0\n", ""), csv=csv)
    assert "no vibration stands out of the noise; state frequency_hz" in problems(path)[0]


def test_a_record_in_which_nothing_moves_is_read_beside_one_that_moves(tmp_path):
    """The bolster may stick; where the noise peaks is not looked at closer than it is sampled."""
    path = fixture_measured.write(
        tmp_path, MEASURED + '[[measurement.test]]\nfile = "two.csv"\nfrequency_hz = 20\n'
    )
    for seed in range(20):
        columns = np.random.default_rng(seed).normal(size=(2, 600))
        (tmp_path / "two.csv").write_text("\n".join(csv_lines(np.arange(600) / 1000.0, *columns)))
        assert len(measured.read(path).tests) == 2


def test_noise_is_what_does_not_repeat(bench):
    test = bench.tests[0]
    found = estimate_noise(test.time, test.displacement, FREQUENCY)
    assert found.std == pytest.approx(NOISE * 1e-3, rel=0.1)
    assert found.share == pytest.approx(NOISE / np.sqrt(0.5 * (1.0 + 0.3**2)), rel=0.1)
    velocity = estimate_noise(test.time, test.velocity, FREQUENCY)
    assert velocity.std == pytest.approx(NOISE * 2.0 * pi * FREQUENCY * 1e-3, rel=0.1)


def test_check_prints_the_noise_that_a_diagnosis_takes(bench):
    told = invoke("check", bench.path)
    for own in harmonic_data(bench).spectra:
        assert f"{1e3 * own.sample_noise[0]:.3g} mm (" in told
        assert own.seen[:2] == (1, 3)


def test_which_files_are_measured_data(tmp_path):
    path = fixture_measured.write(tmp_path)
    assert is_measured(path)
    for other in ("model.toml", "one.csv", "absent.toml"):
        assert not is_measured(tmp_path / other)


def test_a_model_whose_joints_lift_off_is_for_steady_tests():
    """Nothing simulates such joints in a transient or along a loop."""
    sweep = '[sweep]\nfriction_law = "coulomb"\nbeta = 1\namplitude_mm = 1\n'
    for opens in ('[suspension]\njoints = "unilateral"\n', "[effects.lift_off]\n"):
        model = config.parse(sweep + opens)
        assert model_faults(model, {}, ["steady"]) == []
        (fault,) = model_faults(model, {}, ["steady", "transient"])
        assert "joints that lift off" in fault
