"""Measurements that are allowed and unusual, from the files to the files."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from tests.command import invoke
from tests.diagnose.synthetic import drawn
from wedgesweep import config
from wedgesweep import measured as measurements
from wedgesweep.diagnose.diagnosis import excluded_effects
from wedgesweep.diagnose.evaluation import Point, Scenario
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.from_measurement import harmonic_data
from wedgesweep.diagnosis_result import read
from wedgesweep.solvers.periodic import at_rest

MODEL = """\
[sweep]
friction_law = "static-dynamic"
beta = 1.0
amplitude_mm = 0.1
[effects.friction_level]
scale = 0.8
[effects.preload]
force_N = 5.0
[solver]
method = "event-driven"
settle = "steady"
continuation = true
"""
MEASURED = """\
[measurement]
title = "unusual"
model = "model.toml"
uncertain = { friction_level = 0.05 }
columns.time = { column = "t", unit = "s" }
columns.displacement = { column = "d", unit = "m" }
columns.velocity = { column = "v", unit = "m/s" }
"""
TEST = """\
[[measurement.test]]
file = "{i}.csv"
frequency_hz = {frequency}
amplitude_mm = {amplitude}
"""
# The third repeats the second; in the last the bolster does not move. (Hz, mm)
TESTS = ((5.0, 1.5), (11.0, 0.16), (11.0, 0.16), (24.0, 0.09), (24.0, 0.0005))
SAMPLING, PERIODS, NOISE = 2000.0, 8.4, 0.04


@pytest.fixture
def measured(tmp_path):
    model = config.parse(MODEL)
    omega, amplitude = np.array([(2.0 * pi * f, 1e-3 * a) for f, a in TESTS]).T
    rows = simulation.records(model, "static-dynamic", {}, omega, amplitude)
    exact = simulation.respond(rows, at_rest(len(TESTS)), 40).harmonics
    random = np.random.default_rng(0)
    text = MEASURED
    for i, (frequency, amplitude) in enumerate(TESTS):
        time = np.arange(round(PERIODS / frequency * SAMPLING)) / SAMPLING
        turns = np.exp(2j * pi * frequency * np.outer(np.arange(1, 41), time))
        signals = (exact[i] @ turns).real
        level = NOISE * np.maximum(signals.std(axis=1, keepdims=True), [[1e-6], [1e-4]])
        table = np.c_[time, (signals + level * random.normal(size=signals.shape)).T]
        np.savetxt(tmp_path / f"{i}.csv", table, delimiter=",", header="t,d,v", comments="")
        text += TEST.format(i=i, frequency=frequency, amplitude=amplitude)
    (tmp_path / "model.toml").write_text(MODEL)
    (tmp_path / "measured.toml").write_text(text)
    return tmp_path / "measured.toml"


@pytest.mark.acceptance
def test_a_model_with_effects_repeated_tests_and_one_that_sticks(measured):
    out = measured.parent / "found"
    said = invoke("diagnose", measured, "-o", out, "--effects", "preload,friction_level,wedge_stiffness")
    assert "no candidate: preload is part of the model already" in said
    found = read(out)
    assert found.verdict == "nothing-missing"
    # What is uncertain scales the model's own number.
    assert found.document["uncertain"]["friction_level"]["scale"] == pytest.approx(1.0, abs=0.02)
    assert {effect for each in found.document["candidates"] for effect in each["effects"]} == {
        "friction_level",
        "wedge_stiffness",
    }
    assert np.isfinite(found.data["leftover_force"]).all()
    extended = config.load(out / "extended.toml")
    assert extended.effects["preload"] == {"force": 5.0}
    assert extended.effects["friction_level"]["scale"] == pytest.approx(0.8, abs=0.02)
    assert extended.sweep.count == len(set(TESTS))
    # The tests are steady, and so are the cases, whatever the model's own [solver] says.
    told = invoke("run", out / "extended.toml", "-o", measured.parent / "extended.nc", "--n-jobs", 1)
    assert f"{len(set(TESTS))} ok" in told
    assert "did not reach steady state" not in told


def test_a_tone_that_the_model_has_is_not_looked_for(measured):
    """These data have none; what the model has switched off is a candidate still."""
    table = "[effects.stray_vibration]\nacceleration_m_per_s2 = {}\nfrequency_hz = 17.3\n"
    silent = MODEL + table.format(0.0) + "[effects.guide_friction]\n"
    for model, tone in ((MODEL, None), (silent, None), (MODEL + table.format(0.01), 17.3)):
        (measured.parent / "model.toml").write_text(model)
        found = measurements.read(measured)
        assert harmonic_data(found).tone == tone
        excluded = excluded_effects(found)
        assert "preload" in excluded
        assert "guide_friction" not in excluded
    assert harmonic_data(found).tone_std == 0.0


def test_a_place_that_cannot_be_written_to_is_told_at_once(measured):
    said = invoke("diagnose", measured, "-o", measured / "below" / "it", code=2)
    assert f"{measured}: not a directory" in said
    assert "base model" not in said


def test_a_test_in_which_faces_creep_and_age_is_told_apart():
    ageing = {"ageing": {"rate": 0.05, "time": 1e-3}}
    # Between sliding and creeping within the ramp of friction.
    data = drawn(ageing, bench=(np.array([5.0, 24.0, 24.0]), 1e-3 * np.array([1.5, 0.09, 5e-4])))
    for effects, expected in ((ageing, [False, False, True]), ({}, [False] * 3)):
        here = Scenario(effects, Point(np.zeros(0), *data.start()))
        (found,) = data.compare([here], 1e-6)
        assert found.found.all()
        there = Scenario(effects, replace(here.point, warm=found.warm))
        assert data.never_steady(there).tolist() == expected
