"""A short form of ``scripts/fuzz.py`` and ``scripts/kill_campaign.py``, which run for hours."""

from random import Random

import fuzz
import kill_campaign
import pytest
from torture import formats, inputs, kills, specimens
from torture.verdicts import ACCEPTED, HANG, LIMIT, NOT_FINITE, REFUSED, TRACEBACK, WARNING, judge

from tests import fixture_diagnosis
from tests.small_sweep import CONFIG

# Inputs of each kind; those that are solved or drawn take longest.
TRIED = {"config": 8, "run": 1, "measured": 10, "model": 5, "csv": 10, "clock": 8}
FEW = {"dataset": 4, "journal": 4, "figure": 1, "diagnosis": 1, "options": 4}


@pytest.fixture(scope="module")
def given(tmp_path_factory):
    place = tmp_path_factory.mktemp("specimens")
    fixture_diagnosis.write(place / "found")
    (place / "made").mkdir()
    found = {path.name: path.read_bytes() for path in (place / "found").iterdir()}
    return specimens.make(place / "made", found)


def outcomes(given, place, numbers, *words):
    """How the inputs of some numbers end, none of them in a fault."""
    found = []
    for number in numbers:
        kind, command, verdict = fuzz.one(given, fuzz.options(["--seed", "7", *words]), number, place)
        assert not verdict.fault, (number, kind, command, verdict)
        found.append(verdict.outcome)
    return found


@pytest.mark.few(4)
@pytest.mark.parametrize("kind", TRIED | FEW)
def test_hostile_inputs_are_refused_or_understood(given, tmp_path, kind):
    found = outcomes(given, tmp_path / "input", range((TRIED | FEW)[kind]), "--kind", kind)
    assert REFUSED in found or kind in ("figure", "diagnosis", "options", "run")


def test_hostile_files_of_every_format_are_refused_or_understood(given, tmp_path):
    found = outcomes(given, tmp_path / "input", range(2 * len(inputs.FORMATS)), "--formats")
    assert {REFUSED, ACCEPTED} == {*found}


@pytest.mark.few(4)
@pytest.mark.parametrize("name", formats.WRITERS)
def test_a_format_that_is_not_spoiled_is_accepted(given, tmp_path, monkeypatch, name):
    """Else its mutations would all be refused for a fault of the specimen."""
    if name not in given.stored:
        pytest.skip("the format's library is not here")
    monkeypatch.setattr(formats, "spoil", lambda path, content, draw: path.write_bytes(content))
    monkeypatch.chdir(tmp_path)
    assert judge(inputs.KINDS[name](given, tmp_path, Random(7))).outcome == ACCEPTED


def test_a_number_gives_the_same_input_again(given, tmp_path):
    for kind in ("measured", "csv", "one.npz"):
        made = []
        for name in ("one", "other"):
            (tmp_path / name / kind).mkdir(parents=True)
            inputs.KINDS[kind](given, tmp_path / name / kind, Random("7/1"))
            made.append([path.read_bytes() for path in sorted((tmp_path / name / kind).iterdir())])
        assert made[0] == made[1]


@pytest.mark.few(3)
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


@pytest.mark.acceptance
def test_a_killed_sweep_leaves_nothing_and_goes_on(tmp_path):
    scenario = next(each for each in kill_campaign.scenarios() if each.name == "event-driven")
    expected = kills.reference(scenario, tmp_path / "expected")
    before = {path.name for path in tmp_path.iterdir()}
    moment, ended, faults = kills.kill(scenario, expected, tmp_path / "run", Random(3))
    assert not faults, (moment, ended, faults)
    assert {path.name for path in tmp_path.iterdir()} == before | {"run"}
