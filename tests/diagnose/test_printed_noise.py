"""The noise of a record is one number, which `check` and `diagnose` print and the result holds."""

import json
import re

import numpy as np
import pytest

from tests import fixture_measured
from tests.command import invoke
from tests.diagnose import test_loops, test_transients
from wedgesweep.diagnose.evaluation import Point, Scenario
from wedgesweep.diagnose.loop.loop_data import loop_data
from wedgesweep.measured import read

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
