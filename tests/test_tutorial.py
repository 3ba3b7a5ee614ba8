"""The tutorial's commands run as they stand, and every command line in the documentation is one."""

import json
import re
import shlex
import shutil
from pathlib import Path

import as_it_comes
import pytest

from tests import small_sweep
from tests.command import invoke
from wedgesweep.cli import cli

ROOT = Path(__file__).parents[1]
TUTORIAL = ROOT / "docs" / "tutorial.md"
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
# Few candidates and no report, as both have tests of their own.
SHORTENED = {
    "diagnose examples/shaker/measured.toml": ("--effects", "cubic_stiffness,quadratic_drag", "--no-report"),
    "diagnose measured.toml": ("--effects", "guide_friction,directional_damping", "--no-report"),
    "run": ("--n-jobs", "1"),
}


def command_lines(page, *, quoted):
    """Lines of code blocks (and of quoted text) that call wedgesweep, as words; comments are dropped."""
    text = page.read_text()
    lines = re.findall(r"^ {4}wedgesweep (.*)$", text, re.MULTILINE)
    if quoted:
        lines += [each.replace("\n", " ") for each in re.findall(r"`wedgesweep ([^`]+)`", text)]
    parts = [part for line in lines for part in line.split("&& wedgesweep")]
    return [shlex.split(part, comments=True) for part in parts if not part.startswith("COMMAND")]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_command_lines_are_understood(page, tmp_path, monkeypatch):
    """Commands, options and choices exist; files need not, as other commands may write them."""
    monkeypatch.chdir(tmp_path)
    for name, *words in command_lines(page, quoted=True):
        with cli.make_context("wedgesweep", [name, "--help"], resilient_parsing=True) as context:
            command = cli.get_command(context, name)
            assert command is not None, name
            options = {option for each in command.params for option in (*each.opts, *each.secondary_opts)}
            given = {word for word in words if re.match(r"--?[a-z]", word)}
            assert given <= options | {"-h", "--help"}, (name, *words)
            with command.make_context(name, words, parent=context, resilient_parsing=True):
                pass


def edit(path, beginning):
    """Put the line of the tutorial that begins like this into a file, in place of its own."""
    (line,) = [each for each in TUTORIAL.read_text().splitlines() if each.startswith(beginning)]
    text = Path(path).read_text()
    changed = re.sub(rf"^{beginning.strip()}.*$", line.strip(), text, count=1, flags=re.MULTILINE)
    assert changed != text
    Path(path).write_text(changed)


@pytest.mark.acceptance
def test_the_tutorial_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for folder in ("examples", "configs"):
        shutil.copytree(ROOT / folder, folder)
    told, runs = {}, []
    for words in command_lines(TUTORIAL, quoted=False):
        if words[1] == "model.toml":
            edit("measured.toml", "    force = ")
        if "--plugin" in words:
            # In a process of its own, in which an effect from outside of the package stays.
            few = ("--effects", "cubic_stiffness,quintic_stiffness", "--no-report")
            small_sweep.ended("-m", "wedgesweep", *words, *few)
            continue
        words += SHORTENED.get(" ".join(words[:2]), SHORTENED.get(words[0], ()))
        told[words[0]] = invoke(*words)
        runs += [told["run"]] if words[0] == "run" else []
    seal = json.loads(Path("damper-result/diagnosis.json").read_text())
    assert [cause["effect"] for cause in seal["causes"]] == ["guide_friction"]
    low, high = seal["causes"][0]["parameters"]["force_N"]["ci95"]
    assert low <= as_it_comes.FRICTION <= high
    assert not any("did not reach steady state" in each for each in runs)
    found = json.loads(Path("shaker-result/diagnosis.json").read_text())
    truth = json.loads((ROOT / "examples/shaker/truth.json").read_text())["effects"]["cubic_stiffness"]
    (cause,) = found["causes"]
    low, high = cause["parameters"]["coefficient_N_per_mm3"]["ci95"]
    assert low <= truth["coefficient_N_per_mm3"] <= high
    hypotheses = json.loads(Path("shaker-hypothesis/diagnosis.json").read_text())
    assert [cause["effect"] for cause in hypotheses["causes"]] == ["cubic_stiffness"]
    tried = {name: each["accuracy"] for each in hypotheses["candidates"] for name in each["effects"][:1]}
    assert tried["cubic_stiffness"] < tried["quintic_stiffness"] < 0.1
    assert any("verified by Radau at rtol 1e-09: 3 cases out of 450" in each for each in runs)
    assert len(Path("study.csv").read_text().splitlines()) == 451
    assert len(Path("wear.csv").read_text().splitlines()) == 101
    import xarray as xr

    with xr.open_dataset("study.nc") as ds:
        table = ds[["amplitude_ratio", "stick_fraction", "status"]].to_dataframe()
    assert table.shape[0] == 450


def test_examples_are_small():
    for directory in (path for path in (ROOT / "examples").iterdir() if path.is_dir()):
        assert sum(file.stat().st_size for file in directory.iterdir()) < 300_000


def test_the_recording_as_it_comes_is_what_its_script_writes():
    assert as_it_comes.FILE.read_text().splitlines() == as_it_comes.lines()


def test_examples_say_how_they_were_made():
    names = {path.name for path in (ROOT / "examples").iterdir()}
    for hidden in (ROOT / "examples").glob("*hidden.toml"):
        comment = hidden.read_text().split("\n\n")[0].replace("\\\n#", " ")
        words = shlex.split(comment[comment.index("wedgesweep synthesize") :])
        assert {words[2], words[words.index("--tests") + 1], words[words.index("-o") + 1]} <= names
