"""The config: what it reads and how it resolves."""

import tomllib
from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from wedgesweep import config
from wedgesweep.config import Case
from wedgesweep.config.variants import with_method
from wedgesweep.friction.quantities import FRICTION
from wedgesweep.systems.suspension.parameters import SUSPENSION

SWEEP = '[sweep]\nfriction_law = "coulomb"\nbeta = 1.0\namplitude_mm = 0.1\n'
CASE = '[[sweep.case]]\nfriction_law = "coulomb"\nbeta = 0.4\namplitude_mm = 0.3\n'


def swept(**keys: str) -> config.Cases:
    """Sweep of a config whose [sweep] has the given TOML values."""
    given = {"friction_law": '"coulomb"', "beta": "1", "amplitude_mm": "0.1"} | keys
    if "frequency_hz" in keys:
        del given["beta"]
    lines = (f"{key} = {value}" for key, value in given.items())
    return config.parse("\n".join(["[sweep]", *lines])).sweep


def test_everything_but_the_sweep_has_the_papers_value():
    read = config.parse(SWEEP)
    assert read.suspension == {each.name: each.default * each.factor for each in SUSPENSION}
    assert read.friction == {each.name: each.default * each.factor for each in FRICTION}
    assert read.effects == {}
    assert read.suspension["bolster_spring"] == 5100.0
    assert read.sweep.omega_n == pytest.approx(sqrt(5100.0 / 0.7), rel=1e-15)
    assert (read.solver.duration, read.solver.settle_periods) == (1.5, None)
    assert (read.solver.kept_periods, read.solver.samples_per_period) == (3, 256)


def test_a_decimal_of_a_range_is_the_float_it_reads_as():
    sweep = swept(
        beta="{ start = 0.1, stop = 3.0, num = 30 }",
        amplitude_mm="{ start = 0.1, stop = 1.0, num = 10 }",
    )
    assert sweep.beta.tolist() == [round(0.1 * (i + 1), 12) for i in range(30)]
    assert sweep.amplitude.tolist() == [float(f"{i + 1}e-4") for i in range(10)]


def test_log_range_has_equal_ratios_and_exact_ends():
    beta = swept(beta='{ start = 0.1, stop = 2.9, num = 9, spacing = "log" }').beta
    assert (beta[0], beta[-1]) == (0.1, 2.9)
    np.testing.assert_allclose(beta[1:] / beta[:-1], 29.0 ** (1 / 8), rtol=1e-10)


def test_frequency_is_turned_into_beta_of_the_reference():
    sweep = swept(frequency_hz="[20, 30]", omega_n_rad_per_s="80.0")
    np.testing.assert_allclose(sweep.beta, [2 * pi * 20 / 80, 2 * pi * 30 / 80], rtol=1e-15)
    assert sweep.omega_n == 80.0


def test_grid_runs_in_c_order():
    text = SWEEP.replace('"coulomb"', '["exponential", "coulomb"]').replace("1.0", "[1, 2]")
    read = config.parse(text)
    assert read.case_list() == [
        Case(law, beta, 1e-4) for law in ("exponential", "coulomb") for beta in (1.0, 2.0)
    ]
    assert read.sweep.shape == (2, 2, 1)
    dims = {name: dims for name, (dims, _, _) in read.case_coordinates().items()}
    assert dims == {
        "friction_law": ("friction_law",),
        "beta": ("beta",),
        "amplitude": ("amplitude",),
        "frequency": ("beta",),
    }


def test_list_of_cases_stands_instead_of_a_grid():
    text = CASE + CASE.replace("beta = 0.4", "frequency_hz = 20")
    read = config.parse(text)
    beta = 2 * pi * 20 / read.sweep.omega_n
    assert read.case_list() == [Case("coulomb", 0.4, 3e-4), Case("coulomb", beta, 3e-4)]
    assert read.sweep.shape == (2,)
    coordinates = read.case_coordinates()
    assert {dims for dims, _, _ in coordinates.values()} == {("case",)}
    np.testing.assert_allclose(coordinates["frequency"][1][1], 20.0, rtol=1e-14)
    assert config.parse(read.to_toml()) == read


def test_record_holds_the_case_in_si():
    text = "[effects.guide_friction]\nforce_N = 2\n[suspension]\nwedge_angle_deg = 30\n" + SWEEP
    read = config.parse(text)
    record = read.record(read.case_list()[0])
    assert record.shape == (1,)
    assert record["input"]["amplitude"] == 1e-4
    assert record["input"]["omega"] == read.sweep.omega_n
    assert record["suspension"]["wedge_angle"] == pytest.approx(pi / 6)
    assert record["guide_friction"]["force"] == 2.0


def test_resolved_config_reads_back_exactly():
    text = (
        'title = "a \\"quoted\\" \\\\ title,\\nmu \\u03bc \\U0001F600 \\u007f"\n'
        "[suspension]\nbolster_mass_kg = 0.1234567890123456789\n"
        "[effects.guide_friction]\nforce_N = 1\n"
        "[solver]\nsettle_periods = 7\nrtol = 1e-9\n"
        '[sweep]\nfriction_law = "exponential"\nfrequency_hz = { start = 1, stop = 7, num = 4 }\n'
        "amplitude_mm = 0.3\n"
    )
    read = config.parse(text)
    again = config.parse(read.to_toml())
    assert again == read
    assert again.sha256 == read.sha256
    assert again.title == 'a "quoted" \\ title,\nmu \u03bc \U0001f600 \x7f'
    assert again.case_list() == read.case_list()
    assert read.solver.duration is None


def test_resolved_config_tells_whole_numbers_from_others_and_its_digest_follows_every_number():
    resolved = tomllib.loads(config.parse(SWEEP.replace("1.0", "1")).to_toml())
    assert isinstance(resolved["solver"]["kept_periods"], int)
    assert isinstance(resolved["sweep"]["beta"][0], float)
    assert config.parse(SWEEP).sha256 == config.parse(SWEEP.replace("1.0", "1")).sha256
    assert config.parse(SWEEP).sha256 != config.parse(SWEEP.replace("0.1", "0.11")).sha256


def test_with_method_changes_the_solver_alone():
    read = config.parse(SWEEP)
    other = with_method(read, "another")
    assert other.solver == replace(read.solver, method="another")
    assert other.case_list() == read.case_list()
    assert read.solver.method == "radau"


@pytest.mark.parametrize("listed", [False, True])
def test_records_of_all_cases_are_those_of_each(listed):
    grid = 'friction_law = ["exponential", "coulomb"]\nbeta = [0.3, 1.7]\namplitude_mm = [0.2, 1.0, 3.0]\n'
    cases = "".join(
        f'[[sweep.case]]\nfriction_law = "{law}"\nbeta = {beta}\namplitude_mm = 0.7\n'
        for law, beta in (("coulomb", 0.3), ("exponential", 1.1), ("coulomb", 0.7))
    )
    read = config.parse("[suspension]\ncolumn_angle_deg = 6.0\n" + (cases if listed else "[sweep]\n" + grid))
    records = read.records()
    assert records.shape == (3 if listed else 12,)
    for record, case in zip(records, read.case_list(), strict=True):
        assert record.tobytes() == read.record(case).tobytes()
