"""The config's template, its JSON schema, and the configs that are shipped."""

import json
import tomllib
from functools import cache
from math import pi
from pathlib import Path

import numpy as np
import pytest

from wedgesweep import config
from wedgesweep.config import Case
from wedgesweep.config.declarations import root
from wedgesweep.config.variants import with_method
from wedgesweep.effects import EFFECTS
from wedgesweep.friction.quantities import FRICTION
from wedgesweep.outcome import unsettled
from wedgesweep.sweep.run import Sweep
from wedgesweep.systems.suspension.parameters import SUSPENSION

CONFIGS = sorted((Path(__file__).parents[2] / "configs").glob("*.toml"))
# Keys of a case that exclude others.
OTHERS = ("# frequency_hz", "# amplitude_N")
GRID = {"friction_law": "coulomb", "beta": 1.0, "amplitude_mm": 0.1}


def test_template_shows_every_key_and_states_the_defaults():
    text = config.template()
    plain = config.parse('[sweep]\nfriction_law = "coulomb"\nbeta = 1\namplitude_mm = 1\n')
    read = config.parse(text).document
    expected = {name: plain.document[name] for name in plain.document if name != "sweep"}
    # A beginner's solver is not the default one, Radau, and is told how to choose that.
    expected["solver"] |= {"method": "event-driven", "settle": "steady"}
    del expected["solver"]["duration_s"]
    assert {name: read[name] for name in read if name != "sweep"} == expected
    effects = [each for effect in EFFECTS.values() for each in effect.quantities]
    lines = [line.removeprefix("# ") for line in text.splitlines()]
    for quantity in (*SUSPENSION, *FRICTION, *effects):
        assert any(line.startswith(f"{quantity.key} = ") and quantity.meaning in line for line in lines)
    radau = text.replace('method = "event-driven"', 'method = "radau"').replace('settle = "steady"', "")
    radau = radau.replace("# settle_periods = 60", "settle_periods = 60")
    assert 'write method = "radau", and settle_periods or duration_s in place of settle' in text
    assert (config.parse(radau).solver.method, config.parse(radau).solver.settle_periods) == ("radau", 60)
    # It stays valid with its cases uncommented.
    before, after = text.split("\n[sweep]\n")
    cases = after[after.index("# [[sweep.case]]") :].split("\n\n")[0].splitlines()
    lines = [line.removeprefix("# ") for line in cases if not line.startswith(OTHERS)]
    case = Case("coulomb", 0.4, 1e-3, (("suspension.wedge_angle_deg", 30.0),))
    assert config.parse(before + "\n" + "\n".join(lines)).case_list() == [case]


def shipped(name: str) -> config.Config:
    return config.load(next(path for path in CONFIGS if path.stem == name))


def frequencies(read: config.Config) -> np.ndarray:
    return read.sweep.beta * read.sweep.omega_n / (2 * pi)


def has(values: np.ndarray, wanted: float) -> bool:
    return bool(np.isclose(values, wanted, rtol=1e-12, atol=0).any())


def test_paper_has_the_papers_1800_cases():
    read = shipped("paper")
    beta, amplitude = read.sweep.beta, read.sweep.amplitude
    assert (len(read.case_list()), len(beta), len(amplitude)) == (1800, 30, 20)
    assert {0.1, 0.3, 0.4, 1.75, 3.0} <= set(beta.tolist())
    assert (beta.min(), beta.max()) == (0.1, 3.0)
    assert has(frequencies(read), 20.0)
    assert has(frequencies(read), 30.0)
    assert {1.5e-5, 1e-4, 2e-4, 3e-4, 1e-3} <= set(amplitude.tolist())
    assert (amplitude.min(), amplitude.max()) == (5e-6, 4.75e-3)


def test_breakaway_covers_the_experiment():
    read = shipped("breakaway")
    for hertz in (20.0, 30.0, 32.0, 35.0, 40.0):
        assert has(frequencies(read), hertz)
    wanted = {1e-5, 1.2e-5, 1.5e-5, 1.8e-5, 2.2e-5, 3e-5, 4e-5, 5e-5, 1e-4}
    assert wanted <= set(read.sweep.amplitude.tolist())
    assert read.solver.settle_periods == 60


def test_paper_y0_rests_where_the_paper_says():
    read = shipped("paper-y0")
    record = read.record(read.case_list()[0])
    assert record["geometry"]["rest"][0] == pytest.approx(-2.1941e-3, rel=1e-8)
    assert read.sweep.omega_n == 85.3565
    np.testing.assert_allclose(frequencies(read)[[14, 21]], [20.0, 30.0], rtol=1e-12)
    np.testing.assert_allclose(read.sweep.beta, shipped("paper").sweep.beta, rtol=2e-6)


def test_quick_is_small_moves_and_settles(tmp_path):
    quick = shipped("quick")
    assert quick.solver.method == "radau"
    assert quick.sweep.count == 12
    ds = Sweep(with_method(quick, "event-driven"), tmp_path / "quick.nc").run_here()
    assert not unsettled(ds).any()
    assert (ds["amplitude_ratio"] > 0.3).all()
    assert (ds["lift_off_fraction"] == 0.0).all()
    assert (ds["stick_fraction"].sel(friction_law="coulomb", beta=0.6) > 0.1).all()


@cache
def validator():
    """The validator of the config's JSON schema."""
    return pytest.importorskip("jsonschema").Draft202012Validator(config.schema())


def accepted(document: dict) -> bool:
    """Whether the JSON schema accepts a document."""
    return validator().is_valid(document)


def test_schema_is_json_and_itself_valid():
    validator().check_schema(json.loads(json.dumps(validator().schema)))


@pytest.mark.parametrize("path", CONFIGS, ids=lambda path: path.stem)
def test_shipped_configs_read_and_read_back_and_the_schema_accepts_them(path):
    read = config.load(path)
    assert config.parse(read.to_toml()) == read
    assert accepted(tomllib.loads(path.read_text()))
    assert accepted(read.document)


@pytest.mark.parametrize(
    ("document", "valid"),
    [
        ({"sweep": GRID}, True),
        ({"sweep": {"case": [GRID]}}, True),
        ({"sweep": GRID | {"beta": {"start": 1, "stop": 2, "num": 3}}}, True),
        ({"sweep": GRID, "effects": {"guide_friction": {"force_N": 1}}}, True),
        ({}, False),
        ({"sweep": {}}, False),
        ({"sweep": GRID | {"frequency_hz": 1.0}}, False),
        ({"sweep": GRID | {"case": [GRID]}}, False),
        ({"sweep": GRID | {"beta": 0}}, False),
        ({"sweep": GRID | {"friction_law": "viscous"}}, False),
        ({"sweep": GRID, "solver": {"duration_s": 1, "settle_periods": 1}}, False),
        ({"sweep": GRID, "solver": {"samples_per_period": 33}}, False),
        ({"sweep": GRID, "solver": {"kept_periods": True}}, False),
        ({"sweep": GRID, "suspension": {"bolster_mass": 1}}, False),
        ({"sweep": GRID, "effects": {"magic": {}}}, False),
        ({"sweep": GRID, "colour": "red"}, False),
    ],
)
def test_schema_and_parser_agree(document, valid):
    found: list[str] = []
    root().read(document, "", found)
    assert (not found) == valid
    assert accepted(document) == valid


def test_schema_has_the_keys_of_a_rotation_apart():
    """Keys of a translation are none of an oscillator that turns."""
    turning = {"motion": "rotation", "inertia_kg_m2": 1.0, "spring_N_m_per_rad": 1.0, "friction_N_m": 1.0}
    sweep = {"friction_law": "coulomb", "excitation": "force", "frequency_hz": 1.0, "amplitude_N_m": 1.0}
    assert accepted({"sweep": sweep, "oscillator": turning})
    assert not accepted({"sweep": sweep, "oscillator": turning | {"mass_kg": 1.0}})


def objects(schema: object) -> list[dict]:
    """All parts of a JSON schema that describe tables."""
    if isinstance(schema, list):
        return [found for part in schema for found in objects(part)]
    if not isinstance(schema, dict):
        return []
    here = [schema] if schema.get("type") == "object" else []
    return here + [found for part in schema.values() for found in objects(part)]


def test_schema_describes_every_key_and_closes_every_table():
    schema = validator().schema
    tables = objects(schema)
    assert all(each["additionalProperties"] is False for each in tables)
    parts = schema["$defs"]
    keys = [key for each in tables for key in each["properties"].values()]
    assert all((parts[key["$ref"].split("/")[-1]] if "$ref" in key else key)["description"] for key in keys)
    described = {name for each in tables for name in each["properties"]}
    assert {quantity.key for quantity in (*SUSPENSION, *FRICTION)} <= described
