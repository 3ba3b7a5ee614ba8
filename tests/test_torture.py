"""A short form of ``scripts/fuzz.py`` and ``scripts/kill_campaign.py``, which run for hours."""

from random import Random

import fuzz
import kill_campaign
import pytest
from torture import inputs, kills, mutations, specimens
from torture.verdicts import HANG, LIMIT, NOT_FINITE, REFUSED, TRACEBACK, WARNING, judge

from tests import fixture_diagnosis
from tests.small_sweep import CONFIG

# Inputs of each kind; those that are solved or drawn take longest.
TRIED = {"config": 8, "run": 1, "measured": 10, "model": 5, "csv": 10, "netcdf": 8, "stored": 8, "clock": 8}
FEW = {"matlab": 3, "dataset": 4, "journal": 4, "figure": 1, "diagnosis": 1, "options": 4}


@pytest.fixture(scope="module")
def given(tmp_path_factory):
    place = tmp_path_factory.mktemp("specimens")
    fixture_diagnosis.write(place / "found")
    (place / "made").mkdir()
    found = {path.name: path.read_bytes() for path in (place / "found").iterdir()}
    return specimens.make(place / "made", found)


@pytest.mark.parametrize("kind", TRIED | FEW)
def test_hostile_inputs_are_refused_or_understood(given, tmp_path, kind):
    outcomes = []
    for number in range((TRIED | FEW)[kind]):
        _, command, verdict = fuzz.one(given, 7, number, tmp_path / "input", kind)
        assert not verdict.fault, (number, command, verdict)
        outcomes.append(verdict.outcome)
    assert REFUSED in outcomes or kind in ("figure", "diagnosis", "options", "run")


def test_a_number_gives_the_same_input_again(given, tmp_path):
    for kind in (inputs.measured, inputs.csv, inputs.netcdf):
        made = []
        for name in ("one", "other"):
            (tmp_path / name / kind.__name__).mkdir(parents=True)
            kind(given, tmp_path / name / kind.__name__, Random("7/1"))
            files = sorted((tmp_path / name / kind.__name__).iterdir())
            made.append([path.read_bytes() for path in files if path.suffix != ".nc"])
        assert made[0] == made[1]


@pytest.mark.parametrize(
    ("fails", "outcome"),
    [
        ("raise ZeroDivisionError", TRACEBACK),
        ("while True: pass", HANG),
        ("import warnings; warnings.warn('odd', stacklevel=1)", WARNING),
        ("import click; click.echo('noise: nan %')", NOT_FINITE),
        ("raise SystemExit(3)", "exit code"),
    ],
)
def test_faults_are_seen(tmp_path, monkeypatch, fails, outcome):
    def broken(*arguments, **more):
        exec(fails)

    monkeypatch.chdir(tmp_path)
    (tmp_path / "c.toml").write_text(CONFIG)
    monkeypatch.setattr("wedgesweep.cli.configs._grid", broken)
    limit = 0.5 if outcome == HANG else LIMIT
    assert judge(["check", "c.toml"], limit).outcome == outcome


@pytest.mark.parametrize("said", ["title: nan", "versions: numba inf", "-inf   20   0.3"])
def test_a_name_is_no_number(tmp_path, monkeypatch, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "c.toml").write_text(CONFIG)
    monkeypatch.setattr("wedgesweep.cli.configs._grid", lambda _: f"\n{said}")
    assert not judge(["check", "c.toml"]).fault


def test_mutations_are_toml_that_is_read_or_refused():
    import tomllib

    read = 0
    for number in range(300):
        text = mutations.toml(mutations.document(specimens.MEASURED, Random(number)))
        try:
            tomllib.loads(text)
        except (tomllib.TOMLDecodeError, RecursionError):
            continue
        read += 1
    assert read > 200


@pytest.mark.acceptance
def test_a_killed_sweep_leaves_nothing_and_goes_on(tmp_path):
    scenario = next(each for each in kill_campaign.scenarios() if each.name == "event-driven")
    expected = kills.reference(scenario, tmp_path / "expected")
    before = {path.name for path in tmp_path.iterdir()}
    moment, ended, faults = kills.kill(scenario, expected, tmp_path / "run", Random(3))
    assert not faults, (moment, ended, faults)
    assert {path.name for path in tmp_path.iterdir()} == before | {"run"}
