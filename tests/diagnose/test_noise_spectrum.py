"""Noise of transients: its spectrum from the record, or from repeats; what is printed of it; no cause."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from tests import fixture_measured
from tests.command import invoke
from tests.diagnose import test_loops, test_transients
from tests.diagnose.answers import diagnosed
from tests.diagnose.test_transients import HIDDEN, coloured, write
from wedgesweep.diagnose.evaluation import Point, Scenario
from wedgesweep.diagnose.loop.force_noise import FROM_MOTION
from wedgesweep.diagnose.loop.loop_data import loop_data
from wedgesweep.diagnose.noise_bins import noise_of_record
from wedgesweep.diagnose.noise_spectrum import (
    FROM_REPEATS,
    FROM_RESIDUAL,
    FROM_SPECTRUM,
    MOST_NOISE,
    NoiseBins,
    fit_spectra,
    of_noise,
    periodogram,
    repeat_differences,
)
from wedgesweep.diagnose.smoothing import continuous
from wedgesweep.diagnose.transient.from_measurement import transient_data
from wedgesweep.measured import MeasuredError, read
from wedgesweep.report.sampled import NOISE, noise_source

RATE, SIZE, STD = 500.0, 4000, 2e-3
TIME = np.arange(SIZE) / RATE
# A decay of 20 cycles, and where its noise matters (rad a sample).
DECAY = np.exp(-0.4 * TIME) * np.cos(2.0 * np.pi * 2.5 * TIME)
AT = 2.0 * np.pi * np.array([2.5, 10.0]) / RATE


def true_power(pole):
    return STD**2 * (1.0 - pole**2) / (1.0 + pole**2 - 2.0 * pole * np.cos(AT))


@pytest.mark.few(1)
@pytest.mark.parametrize("pole", [0.0, 0.5, 0.9])
def test_noise_below_a_decay_is_told_from_what_lies_above(pole):
    ratios = []
    for seed in range(6):
        record = DECAY + STD * coloured(np.random.default_rng(seed), SIZE, pole)
        ratios.append(noise_of_record(record)(AT) / true_power(pole))
    # Too low an estimate would look like a misfit, so that it errs to the other side.
    assert np.min(ratios) > 0.4
    assert np.median(ratios) < 3.0


def test_noise_between_what_is_known_of_it_is_not_taken_for_too_small():
    """Bins at the lowest and the highest frequencies leave open how the noise falls from one to the other."""
    pole, between = 0.9, np.linspace(0.05, 2.0, 100)
    true = (1.0 - pole**2) / (1.0 + pole**2 - 2.0 * pole * np.cos(between))
    least: list[tuple[float, float]] = []
    for seed in range(40):
        frequency, power = periodogram(coloured(np.random.default_rng(seed), 600, pole))
        kept = (np.arange(frequency.size) < 8) | (frequency > 2.0)
        (estimate,) = fit_spectra([[NoiseBins.of(frequency[kept], power[kept])]], MOST_NOISE)
        alone = replace(estimate, likewise=())
        least.append(((alone(between) / true).min(), (estimate(between) / true).min()))
    of_one_pole, of_all = np.median(least, axis=0)
    assert of_one_pole < 0.5
    assert 0.8 < of_all < 1.3


def test_what_does_not_repeat_is_noise():
    rng = np.random.default_rng(0)
    records = []
    for gain, lag in ((1.0, 0), (1.03, 4), (0.98, -3)):
        later = np.exp(-0.4 * (TIME - lag / RATE)) * np.cos(2.0 * np.pi * 2.5 * (TIME - lag / RATE))
        records.append(gain * later + 0.1 * gain + STD * coloured(rng, SIZE, 0.9))
    found = of_noise(repeat_differences(records), FROM_REPEATS)
    assert found.std == pytest.approx(STD, rel=0.3)
    assert found.correlation == pytest.approx(0.9, abs=0.08)


@pytest.mark.acceptance
def test_coloured_noise_is_no_cause(tmp_path):
    found = diagnosed(write(tmp_path, pole=0.9), [*HIDDEN, "quadratic_drag"])
    assert (found.verdict, found.causes) == ("nothing-missing", [])


@pytest.mark.acceptance
def test_repeats_tell_the_noise_and_do_not_hide_the_cause(tmp_path):
    path = write(tmp_path, effects={"viscous_damping": HIDDEN["viscous_damping"]}, pole=0.9, repeats=2)
    data = transient_data(read(path))
    assert {each.spectra[0].source for each in data.windows} == {FROM_REPEATS}
    found = diagnosed(path, ["viscous_damping", "friction_level"])
    assert [each["effect"] for each in found.causes] == ["viscous_damping"]
    assert found.document["misfit"]["tests"][0]["noise_from"] == FROM_REPEATS


def test_a_repeat_of_nothing_is_told(tmp_path):
    path = write(tmp_path)
    path.write_text(path.read_text() + 'repeat_of = "drop9.csv"\n')
    with pytest.raises(MeasuredError, match="not the file of an earlier test"):
        read(path)


def test_the_report_knows_where_any_noise_comes_from():
    assert set(NOISE) == {FROM_REPEATS, FROM_SPECTRUM, FROM_RESIDUAL, FROM_MOTION}
    told = noise_source([{"noise_from": FROM_REPEATS}] * 2 + [{"name": "of an older version"}])
    assert told == NOISE[FROM_REPEATS]


def test_jumps_of_dry_friction_are_no_noise_of_an_accelerometer():
    rng, time = np.random.default_rng(7), np.arange(3000) / 1000.0
    motion = np.exp(-time) * np.cos(15.0 * time) + 0.2 * np.sign(np.sin(15.0 * time))
    noise = 0.01 * rng.standard_normal(time.size)
    assert noise_of_record(motion + noise).std > 1.5 * 0.01
    assert noise_of_record(continuous(motion + noise)).std == pytest.approx(0.01, rel=0.3)
    smooth = np.cos(15.0 * time) + noise
    assert noise_of_record(continuous(smooth)).std == pytest.approx(0.01, rel=0.1)


# Writers of the files, and the key of the noise in diagnosis.json.
KINDS = {
    "steady": (fixture_measured.write, "noise_displacement_mm"),
    "transient": (test_transients.write, "noise_displacement_mm"),
    "loop": (test_loops.write, "noise_force_N"),
}


def printed(told):
    """The noise of the first response of each test in what a command printed."""
    return [float(each) for each in re.findall(r"^\S+\.csv\b.*? (\S+) (?:mm|N) \(", told, re.MULTILINE)]


@pytest.mark.parametrize("kind", KINDS)
def test_check_and_diagnose_tell_the_same_noise(tmp_path, kind):
    write, key = KINDS[kind]
    path, out = write(tmp_path), tmp_path / "found"
    checked = printed(invoke("check", path))
    options = ("--effects", "viscous_damping", "--no-report", "--time-limit", "0.001s")
    assert printed(invoke("diagnose", path, "-o", out, *options, code=3)) == checked
    tests = json.loads((out / "diagnosis.json").read_text())["misfit"]["tests"]
    assert [each[key] for each in tests[: len(checked)]] == pytest.approx(checked, rel=0.01)


def test_a_cause_does_not_change_the_noise_that_is_told_of_a_loop(tmp_path):
    data = loop_data(read(test_loops.write(tmp_path)))
    point = Point(np.zeros(0), *data.start())
    found = data.renewed(Scenario({"guide_friction": {"force": 10.0}}, point))
    before, after = (each.described(point)[0] for each in (data, found))
    assert after["noise_force_N"] == before["noise_force_N"] == before["noise_force_fitted_N"]
    assert after["noise_force_fitted_N"] > 2.0 * before["noise_force_N"]  # reversals, by noise of the motion
