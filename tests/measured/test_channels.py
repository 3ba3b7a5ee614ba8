"""Recorded inputs, further channels and numbers that differ from test to test."""

import numpy as np
import pytest

from tests import fixture_measured
from tests.fixture_measured import MEASURED, vibration
from wedgesweep import measured
from wedgesweep.measured import channels

RECORDED = (
    MEASURED.replace("amplitude_mm = 0.3\namplitude_std = 0.01\n", "")
    .replace(
        'velocity = { column = "v", unit = "mm/s" }',
        'input = { column = "v", unit = "g", quantity = "acceleration" }',
    )
    .replace('title = "bench"', 'title = "bench"\ninput_gain_std = 0.02')
)


def read(directory, text):
    return measured.read(fixture_measured.write(directory, text))


def problems(directory, text):
    with pytest.raises(measured.MeasuredError) as caught:
        read(directory, text)
    return "\n".join(caught.value.problems)


def test_a_recorded_input_has_the_unit_of_its_quantity(tmp_path):
    found = read(tmp_path, RECORDED)
    assert found.recorded_input == "acceleration"
    assert found.input_gain_std == 0.02
    np.testing.assert_allclose(found.tests[0].input, 9.80665 * vibration()[2], rtol=1e-5)
    assert found.tests[0].amplitude is None


def test_an_absolute_acceleration_alone_is_a_response(tmp_path):
    text = RECORDED.replace(
        'displacement = { column = "d", unit = "mm" }',
        'acceleration = { column = "d", unit = "mm/s^2", of = "absolute" }',
    )
    found = read(tmp_path, text)
    assert found.tests[0].displacement is None
    assert found.columns["acceleration"]["of"] == "absolute"
    np.testing.assert_allclose(found.tests[0].acceleration, 1e-3 * vibration()[1], rtol=1e-5)


def test_the_kind_of_the_measurement_is_that_of_tests_that_state_none(tmp_path):
    free = MEASURED.replace("frequency_hz = 20.0\namplitude_mm = 0.3\namplitude_std = 0.01\n", "")
    text = free.replace('title = "bench"', 'kind = "transient"\nundriven = true')
    assert "measurement.undriven" in problems(tmp_path, text)
    loop = free.replace('title = "bench"', 'kind = "loop"')
    assert "measurement.columns.force: missing" in problems(tmp_path, loop)
    own = loop.replace("[[measurement.test]]", '[[measurement.test]]\nkind = "steady"')
    assert read(tmp_path, own).tests[0].kind == "steady"


def test_a_delay_of_a_response_may_be_fitted_beside_one_force_only():
    """Of displacement against the force of loops, also beside free decays; not against a velocity."""
    late, force = {"delay_std_ms": 1.0}, {"force": {}}
    stds = {"input_gain_std": 0.0, "input_harmonics_std": 0.0, "uncertain": {}}
    loops, decays = {"displacement": late, **force}, {"displacement": late}
    assert channels.faults({"loop": loops, "transient": decays}, stds, None) == []
    two = {**decays, "velocity": {}}
    (fault,) = channels.faults({"loop": loops, "transient": two}, stds, None)
    assert fault.startswith("displacement.delay_std_ms: only a delay of force, input or their only response")


@pytest.mark.parametrize("unit", ["m/s^2", "m/s2", "m/s²"])
def test_units_are_read_in_any_spelling_and_written_in_one(tmp_path, unit):
    channel = f'acceleration = {{ column = "d", unit = "{unit}" }}'
    text = RECORDED.replace('displacement = { column = "d", unit = "mm" }', channel)
    found = read(tmp_path, text)
    assert found.columns["acceleration"]["unit"] == "m/s^2"
    np.testing.assert_allclose(found.tests[0].acceleration, vibration()[1], rtol=1e-5)


def test_a_test_has_numbers_of_its_own(tmp_path):
    found = read(tmp_path, RECORDED + 'model = { "suspension.bolster_mass_kg" = 1.4 }\n')
    assert found.model_of(found.tests[0]).suspension["bolster_mass"] == 1.4
    assert found.model.suspension["bolster_mass"] == 0.7


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('quantity = "acceleration"', 'quantity = "displacement"', 'columns.input.unit: "g" is no unit of'),
        ('unit = "g", quantity = "acceleration"', 'unit = "N", quantity = "force"', "no force drives"),
        ('displacement = { column = "d", unit = "mm" }\n', "", "input: there is no response"),
        ("displacement = {", "force = {", "force.unit"),
        (
            'displacement = { column = "d", unit = "mm" }',
            'force = { column = "d", unit = "N" }',
            "no force acts on a mass whose base moves",
        ),
        ("frequency_hz = 20.0", "frequency_hz = 20.0\namplitude_mm = 0.3", "amplitude_mm: the input is"),
        (
            "frequency_hz = 20.0",
            'frequency_hz = 20.0\nmodel = { "suspension.bolster_mass" = 1.0 }',
            'test[0].model: suspension.bolster_mass: the model has no such number',
        ),
        (
            "frequency_hz = 20.0",
            'frequency_hz = 20.0\nmodel = { "suspension.bolster_mass_kg" = -1.0 }',
            "test[0].model: suspension.bolster_mass_kg: -1.0 is out of range",
        ),
        (
            'input = { column = "v", unit = "g", quantity = "acceleration" }\n',
            "",
            "measurement.input_gain_std: there is no recorded input",
        ),
        (
            "input_gain_std = 0.02",
            "input_harmonics_std = 0.004",
            "measurement.input_harmonics_std: the input is recorded",
        ),
        (
            "frequency_hz = 20.0",
            f'frequency_hz = 20.0\nmodel = {{ "suspension.bolster_mass_kg" = 1{400 * "0"} }}',
            "test[0].model: suspension.bolster_mass_kg: 1000",
        ),
        (
            'displacement = { column = "d", unit = "mm" }\n'
            'input = { column = "v", unit = "g", quantity = "acceleration" }\n',
            'force = { column = "d", unit = "N" }\n',
            "measurement.columns.displacement: missing",
        ),
    ],
)  # fmt: skip
def test_faults(tmp_path, old, new, words):
    assert old in RECORDED
    assert words in problems(tmp_path, RECORDED.replace(old, new))


def test_absolute_motion_needs_the_input(tmp_path):
    text = MEASURED.replace('unit = "mm" }', 'unit = "mm", of = "absolute" }')
    assert "displacement.of: without a recorded input" in problems(tmp_path, text)


STATED = MEASURED.replace('title = "bench"', 'title = "bench"\ninput_harmonics_std = 0.004')


def test_harmonics_of_a_stated_input_are_uncertain_where_that_is_stated(tmp_path):
    assert read(tmp_path, MEASURED).input_harmonics_std == 0.0
    found = read(tmp_path, STATED)
    assert found.input_harmonics_std == 0.004


def test_only_steady_tests_have_harmonics_of_a_stated_input(tmp_path):
    text = STATED.replace(
        "frequency_hz = 20.0\namplitude_mm = 0.3\namplitude_std = 0.01\n", 'kind = "transient"\n'
    )
    assert "measurement.input_harmonics_std: there is no test of kind steady" in problems(tmp_path, text)


COMMON = "[measurement.uncertain]\ninput_distortion = 0.004\n"


def test_harmonics_of_a_stated_input_may_be_the_same_in_all_tests(tmp_path):
    found = read(tmp_path, COMMON + MEASURED)
    assert found.uncertain == {"input_distortion": 0.004}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (RECORDED.replace("input_gain_std = 0.02", ""), "the input is recorded, and its harmonics with it"),
        (
            MEASURED.replace("frequency_hz = 20.0\namplitude_mm = 0.3\namplitude_std = 0.01\n", "")
            .replace("[[measurement.test]]", '[[measurement.test]]\nkind = "transient"'),
            "there is no test of kind steady",
        ),
        (
            MEASURED + '[[measurement.test]]\nfile = "one.csv"\nkind = "transient"\n',
            "tests of kind transient have other inputs; diagnose them by themselves",
        ),
    ],
)  # fmt: skip
def test_only_stated_inputs_have_the_same_harmonics(tmp_path, text, words):
    assert f"measurement.uncertain.input_distortion: {words}" in problems(tmp_path, COMMON + text)
