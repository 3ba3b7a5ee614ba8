"""The config: what it refuses, and what it says then."""

from math import inf, nan

import numpy as np
import pytest

from tests.small_sweep import faults
from wedgesweep import config
from wedgesweep.config import ConfigError
from wedgesweep.config.keys import Number
from wedgesweep.config.tables import table
from wedgesweep.config.variants import with_method
from wedgesweep.quantity import Quantity

SWEEP = '[sweep]\nfriction_law = "coulomb"\nbeta = 1.0\namplitude_mm = 0.1\n'
STEADY = '[solver]\nmethod = "event-driven"\nsettle = "steady"\ncontinuation = true\n'
OSCILLATOR = "[oscillator]\nmass_kg = 1.0\nspring_N_per_mm = 1.0\nnormal_force_N = 1.0\n"
UNILATERAL = '[suspension]\njoints = "unilateral"\n'
CASE = '[[sweep.case]]\nfriction_law = "coulomb"\nbeta = 0.4\namplitude_mm = 0.3\n'


def problem(text: str) -> str:
    (only,) = faults(text)
    return only


def test_all_faults_are_reported_at_once_with_their_paths():
    found = faults("""
        titel = "x"
        [suspension]
        bolster_mas_kg = 1.0
        wedge_mass_kg = -1
        [effects.guide_frction]
        [sweep]
        friction_law = ["coulomb", "Exponental"]
        beta = [0.3, 0.2, -0.2]
        [solver]
        rtol = "small"
    """)
    expected = [
        ("titel", '"title"'),
        ("suspension.bolster_mas_kg", '"bolster_mass_kg"'),
        ("suspension.wedge_mass_kg", "at least 0"),
        ("effects.guide_frction", '"guide_friction"'),
        ("sweep.friction_law[1]", '"exponential"'),
        ("sweep.beta[2]", "greater than 0"),
        ("sweep.beta", "increasing"),
        ("sweep.amplitude_mm", "missing"),
        ("solver.rtol", "not a finite number"),
    ]
    assert len(found) == len(expected)
    for path, hint in expected:
        assert any(each.startswith(f"study.toml: {path}: ") and hint in each for each in found)


@pytest.mark.parametrize(
    ("table_name", "line", "hint"),
    [
        ("suspension", "bolster_mass_kg = true", "not a finite number"),
        ("suspension", "bolster_mass_kg = nan", "not a finite number"),
        ("suspension", f"bolster_mass_kg = 1{'0' * 400}", "out of range"),
        ("suspension", "wedge_angle_deg = 90", "less than 90"),
        ("solver", "rtol = 0.1", "at most 0.01"),
        ("solver", "kept_periods = 1", "at least 2"),
        ("solver", "kept_periods = 3.0", "whole number"),
        ("solver", "samples_per_period = 33", "multiple of 2"),
        ("solver", "duration_s = 0", "greater than 0"),
        ("solver", 'method = "radua"', '"radau"'),
        ("solver", 'method = ["radau"]', "unknown name"),
        ("suspension", "restitution = 0.5", 'write joints = "unilateral"'),
        ("suspension", 'restitution = 1.0\njoints = "unilateral"', "less than 1"),
        ("suspension", 'wedge_mass_kg = 0\njoints = "unilateral"', "greater than 0"),
        ("suspension", 'damping = "fixed"', "variable, constant"),
        ("solver", "continuation = true", 'write method = "event-driven" and settle = "steady"'),
        ("solver", 'continuation = true\nmethod = "event-driven"', 'settle = "steady"'),
        ("solver", 'continuation = "yes"', "neither true nor false"),
    ],
)
def test_a_value_that_cannot_be_right(table_name, line, hint):
    found = problem(f"[{table_name}]\n{line}\n{SWEEP}")
    assert found.startswith(f"study.toml: {table_name}.{line.split()[0]}: ")
    assert hint in found


@pytest.mark.parametrize(
    ("key", "value", "hint"),
    [
        ("beta", "[]", "empty"),
        ("beta", "[0.2, 0.1]", "0.1 follows 0.2"),
        ("beta", "[[1]]", "not a finite number"),
        ("beta", "{ start = 1, stop = 2 }", "num: missing; write num = 30"),
        ("beta", "{ start = 1, stop = 2, num = 1 }", "1 increasing values"),
        ("beta", "{ start = 2, stop = 1, num = 2 }", "2 increasing values"),
        ("beta", "{ start = 1, stop = 2, num = 2.5 }", "whole number"),
        ("beta", "{ start = 1, stop = 2, nun = 2, num = 2 }", '"num"'),
        ("amplitude_mm", '{ start = 0, stop = 1, num = 2, spacing = "log" }', "greater than 0"),
        ("amplitude_mm", '{ start = 1, stop = 2, num = 2, spacing = "lin" }', '"linear"'),
        ("friction_law", "[]", "empty"),
        ("friction_law", '["coulomb", "coulomb"]', "repeated"),
        ("friction_law", "1", "unknown name"),
        ("omega_n_rad_per_s", "0.0", "greater than 0"),
    ],
)
def test_a_sweep_that_cannot_be_right(key, value, hint):
    given = {"friction_law": '"coulomb"', "beta": "1", "amplitude_mm": "1"} | {key: value}
    found = problem("[sweep]\n" + "\n".join(f"{each} = {given[each]}" for each in given))
    assert found.startswith(f"study.toml: sweep.{key}")
    assert hint in found


@pytest.mark.parametrize(
    ("text", "path"),
    [
        (SWEEP + "frequency_hz = 20\n", "sweep.frequency_hz"),
        (SWEEP + "[solver]\nduration_s = 1\nsettle_periods = 9\n", "solver.settle_periods"),
        (SWEEP + CASE, "sweep.friction_law"),
        (CASE + "frequency_hz = 20\n", "sweep.case[0].frequency_hz"),
    ],
)
def test_settings_that_exclude_each_other(text, path):
    assert any(
        each.startswith(f"study.toml: {path}: ") and "exclude each other" in each for each in faults(text)
    )


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "sweep: missing"),
        ("sweep = 1", "sweep: 1 is not a table"),
        ("[sweep.case]\nbeta = 1", "sweep.case: "),
        ("[sweep]\ncase = []", "sweep.case: [] is not a list of tables"),
        ("[sweep]\ncase = [1]", "sweep.case[0]: 1 is not a table"),
        (CASE + CASE, "sweep.case[1]: repeats sweep.case[0]"),
        (
            CASE + "suspension.locked_in = 1.0\n" + CASE,
            "sweep.case[1].suspension.locked_in: missing;",
        ),
        (CASE + "beat = 1\n", 'sweep.case[0].beat: unknown key; did you mean "beta"?'),
        (CASE + STEADY, "solver.continuation: needs a grid, not a list of cases"),
        (
            SWEEP + "[suspension]\nwedge_angle_deg = 5\ncolumn_angle_deg = -5\n",
            "suspension.column_angle_deg: -5.0 closes a wedge of 5.0 deg; the sum of both angles",
        ),
        (
            SWEEP + UNILATERAL + "[effects.presliding]\nlength_mm = 0.1",
            "effects.presliding: does not go with",
        ),
        (
            SWEEP + UNILATERAL + "[effects.cross_slip]\nvelocity_mm_per_s = 1",
            "effects.cross_slip: does not go with unilateral joints; valid here: ",
        ),
        (
            SWEEP + "[effects.cubic_stiffness]\ncoefficient_N_per_mm3 = -2.0\n",
            "effects.cubic_stiffness.coefficient_N_per_mm3: leaves",
        ),
        (
            'title = "x"\n[sweep\n',
            "not valid TOML: Expected ']' at the end of a table declaration (at line 2",
        ),
    ],
)
def test_a_whole_that_cannot_be_right(text, told):
    assert problem(text).startswith(f"study.toml: {told}")


@pytest.mark.parametrize("sweep", [SWEEP, CASE])
def test_coulomb_without_lean_is_refused_unless_frictionless(sweep):
    upright = "[suspension]\ncolumn_angle_deg = 0\n"
    assert "friction.dynamic = 0" in problem(upright + sweep)
    config.parse(upright + "[friction]\ndynamic = 0\n" + sweep)
    config.parse(upright + sweep.replace("coulomb", "exponential"))
    # Springs that soften and still hold the weight.
    config.parse(sweep + "[effects.cubic_stiffness]\ncoefficient_N_per_mm3 = -0.5\n")


def test_a_file_that_cannot_be_read_is_a_config_error(tmp_path):
    latin = tmp_path / "latin.toml"
    latin.write_bytes('title = "Größe"'.encode("latin-1"))
    for path in (tmp_path / "none.toml", tmp_path, latin):
        with pytest.raises(ConfigError, match=path.name):
            config.load(path)
    # A byte order mark is no fault.
    latin.write_bytes(b"\xef\xbb\xbf" + SWEEP.encode())
    assert config.load(latin) == config.parse(SWEEP)


@pytest.mark.parametrize("default", [nan, inf])
def test_a_number_whose_neutral_value_is_a_limit_must_be_given(default):
    limit = Number.of(Quantity("stiffness_N_per_mm", default, "stiffness", above=0.0))
    found: list[str] = []
    table("spring", "a spring", limit).read({}, "effects.spring", found)
    assert found == ["effects.spring.stiffness_N_per_mm: missing; write stiffness_N_per_mm = ..."]


def test_another_method_must_suit_the_other_settings():
    read = config.parse(SWEEP + STEADY)
    with pytest.raises(ConfigError, match=r'solver "radau": solver\.settle: .*\n.*solver\.continuation'):
        with_method(read, "radau")


def test_constant_damping_needs_the_force_of_its_springs():
    text = SWEEP + '[suspension]\ndamping = "constant"\n'
    found = problem(text)
    assert found.startswith("study.toml: suspension.wedge_preload_N: 0 presses no wedge")
    assert "greater than 0" in found
    case = config.parse(text + "wedge_preload_N = 4.0\n").records(np.array([0]))
    assert case["geometry"]["spring_on_bolster"] == 1.0


def test_unilateral_joints_need_an_angle_and_friction_that_does_not_grow():
    law = SWEEP.replace("coulomb", "exponential")
    joints = '[suspension]\njoints = "unilateral"\ncolumn_angle_deg = 0.0\n[friction]\nstatic = 0.2\n'
    angle, static = faults(law + joints)
    assert "suspension.column_angle_deg" in angle
    assert "friction.static" in static


@pytest.mark.parametrize(
    ("law", "effect"), [("lugre", "stribeck"), ("lugre", "ageing"), ("hyperbolic", "stribeck")]
)
def test_an_effect_that_a_law_has_no_place_for(law, effect):
    more = "bristle_stiffness_N_per_mm = 100.0\n" if law == "lugre" else ""
    model = OSCILLATOR + more + SWEEP.replace("coulomb", law)
    assert effect not in config.parse(model).possible_effects
    numbers = {"stribeck": "peak = 0.1\nvelocity_mm_per_s = 10.0\n", "ageing": "rate = 0.1\ntime_s = 0.1\n"}
    (problem,) = faults(model + f"[effects.{effect}]\n{numbers[effect]}")
    assert f"effects.{effect}: {law}" in problem


@pytest.mark.parametrize(
    ("more", "possible"),
    [
        ("", True),
        ("[effects.presliding]\nlength_mm = 0.1\n", False),
        ("[effects.stribeck]\nvelocity_mm_per_s = 1.0\npeak = 0.1\n", True),
    ],
)
def test_an_effect_that_one_of_the_model_excludes_is_no_candidate(more, possible):
    assert ("damper_play" in config.parse(OSCILLATOR + more + SWEEP).possible_effects) == possible


def test_locked_in_forces_need_set_valued_friction_and_nothing_that_yields():
    def may_jam(model):
        return "jamming" in config.parse(model).possible_effects

    assert may_jam(SWEEP)
    assert not may_jam(SWEEP.replace("coulomb", "exponential"))
    assert not may_jam("[suspension]\nlocked_in = 0.5\n" + SWEEP)
    assert not may_jam(UNILATERAL + SWEEP)
    column = "[effects.column_compliance]\nstiffness_N_per_mm = 100.0\n"
    assert not may_jam(SWEEP + column)
    (problem,) = faults("[suspension]\nlocked_in = 0.5\n" + SWEEP + column)
    assert "suspension.locked_in" in problem
    assert "effects.column_compliance" in problem
    (record,) = config.parse("[suspension]\nlocked_in = 0.5\n" + SWEEP).records()
    assert record["jamming"]["locked_in"] == 0.5


def test_a_damper_behind_a_spring_needs_friction_and_damping_that_follow_the_same_body():
    own = OSCILLATOR + 'contact = "ground"\n'
    effect = "[effects.series_compliance]\nstiffness_N_per_mm = 10.0\n"
    (problem,) = faults(own + effect + SWEEP)
    assert "effects.series_compliance: damping follows the base" in problem
    assert "series_compliance" not in config.parse(own + SWEEP).possible_effects
    forced = SWEEP.replace("amplitude_mm", "amplitude_N") + 'excitation = "force"\n'
    assert "series_compliance" in config.parse(own + effect + forced).effects
