"""The examples of docs/extending.md, taken from the page and run; effects from files outside of it."""

import json
import os
import re
import sys
from pathlib import Path

import pytest
import xarray as xr

from tests import fixture_dataset, small_sweep
from wedgesweep import effects, figures, plugins
from wedgesweep.errors import InputError
from wedgesweep.figures import catalogue

PAGE = Path(__file__).parents[1] / "docs" / "extending.md"
REPOSITORY = PAGE.parents[1]

# A small law and effect through the command line, in a process that has registered them.
SWEEP = """
[effects.maxwell]
stiffness_N_per_mm = 3.0
damping_N_s_per_m = 30.0

[sweep]
friction_law = ["fading", "coulomb"]
frequency_hz = 14.0
amplitude_mm = 1.0

[solver]
rtol = 1e-8
settle_periods = 40
kept_periods = 2
keep_waveforms = false
"""
RUN = """
import sys

import fading
import maxwell

from wedgesweep import effects, friction

friction.register("fading", fading)
effects.register(maxwell)

from wedgesweep.cli import cli

for solver in sys.argv[1:]:
    options = ("-o", f"{solver}.nc", "--solver", solver, "--n-jobs", "1")
    assert not cli(["run", "sweep.toml", *options], standalone_mode=False)
"""
ENERGIES = """
import json

names = ("lowest", "highest", "time", "stuck_time", "dissipated", "supplied")
print(json.dumps([{name: float(run.sums[0][name]) for name in names} for run in runs]))
"""


def example(file):
    """Code of the page's example for a file."""
    block = re.search(rf"```python\n# {re.escape(file)}\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert block, file
    return block[1]


@pytest.fixture
def package(tmp_path, monkeypatch):
    """An empty package that can be imported, gone after the test: its name and its folder."""
    folder = tmp_path / "extension"
    folder.mkdir()
    (folder / "__init__.py").touch()
    monkeypatch.syspath_prepend(tmp_path)
    yield "extension", folder
    for name in [name for name in sys.modules if name.split(".")[0] == "extension"]:
        del sys.modules[name]


@pytest.fixture
def python(tmp_path):
    """Run code beside examples of the page, in a process of its own: what it registers ends with it."""

    def run(code, examples, *arguments):
        for file in examples:
            (tmp_path / file).write_text(example(file))
        places = os.pathsep.join([str(REPOSITORY), str(tmp_path)])
        return small_sweep.ended("-c", code, *arguments, directory=tmp_path, PYTHONPATH=places).stdout

    return run


@pytest.mark.acceptance
def test_law_and_effect(python, tmp_path):
    (tmp_path / "sweep.toml").write_text(SWEEP)
    solvers = ("event-driven", "radau")
    # One process for both: what they share is compiled once.
    python(RUN, ("fading.py", "maxwell.py"), *solvers)
    found = {solver: xr.load_dataset(tmp_path / f"{solver}.nc") for solver in solvers}
    for ds in found.values():
        assert ds["friction_law"].values.tolist() == ["fading", "coulomb"]
        assert (ds["status"] == 0).all()
        assert ds["supplied_energy"].values == pytest.approx(ds["dissipated_energy"].values, rel=1e-5)
    for name in ("amplitude_ratio", "dissipated_energy", "stick_fraction"):
        one, other = (ds[name].values for ds in found.values())
        assert one == pytest.approx(other, rel=1e-5), name


@pytest.mark.acceptance
def test_system(python):
    code = example("run_two_masses.py") + ENERGIES
    runs = json.loads(python(code, ("two_masses.py",)).splitlines()[-1])
    for run in runs:
        assert run["supplied"] == pytest.approx(run["dissipated"], rel=1e-6)
        assert 0.0 < run["stuck_time"] < run["time"]
    assert runs[0] == pytest.approx(runs[1], rel=1e-6)


def test_figure(package, monkeypatch):
    name, folder = package
    (folder / "normal_force.py").write_text(example("wedgesweep/figures/normal_force.py"))
    kind = catalogue.declared(folder, name)["normal-force"]
    assert kind.description
    monkeypatch.setitem(figures.FIGURES, kind.name, kind)
    figure = figures.draw(fixture_dataset.build(), kind.name)
    figure.draw_without_rendering()
    assert len(figure.axes) == 3
    assert figure.axes[0].get_ylabel() == "smallest normal force [N]"
    assert kind.picks == ("count",)
    figures.draw(fixture_dataset.build(), kind.name, law="coulomb")
    with pytest.raises(ValueError, match="minimum_normal_force"):
        figures.draw(fixture_dataset.build().drop_vars("minimum_normal_force"), kind.name)


HYPOTHESIS = (REPOSITORY / "examples" / "quintic_stiffness.py").read_text()
FORCE = "    return -p.quintic_stiffness.force * (z / TRAVEL) ** 5"
# What is changed in a file that works, and what is said of it.
FAULTS = {
    "syntax": ("def force_on_mass(", "def force_on_mass((", "SyntaxError"),
    "exception": ("TRAVEL = 1e-3", "TRAVEL = 1 / 0", "ZeroDivisionError: division by zero"),
    "no effect": ("EFFECT = Effect(", "OTHER = Effect(", "EFFECT: missing"),
    "taken": ('name="quintic_stiffness"', 'name="viscous_damping"', "name: 'viscous_damping' is taken"),
    "family": ("missing-force", "missing-froce", "family: unknown name 'missing-froce'; did you mean"),
    "extends": ('extends=("force",)', 'extends=("size",)', "extends: unknown name 'size'"),
    "arguments": ("(z, velocity, y, p)", "(z, y, p)", "(z, y, p); the hook has (z, velocity, y, p)"),
    "linear": ("TRAVEL = 1", "LINEAR = True\nsliding = None\nTRAVEL = 1", "LINEAR: an effect with states or"),
    "equation": ("(z/z_1)^5", "(z/z_1^5", "EQUATIONS"),
    "symbol": ('"z_1"', '"z_2"', "symbol 'z_1' is not explained"),
    "name": (FORCE, FORCE.replace("TRAVEL", "LENGTH"), "force_on_mass: NameError: name 'LENGTH'"),
    "number": (FORCE, FORCE.replace(".force ", ".size "), "p has no part or number 'size'"),
    "not neutral": (FORCE, FORCE.replace("-p", "1.0 - p"), "is 1 at the neutral value of the effect"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_fault_is_told_with_file_and_line(fault, tmp_path):
    good, bad, told = FAULTS[fault]
    assert good in HYPOTHESIS
    file = tmp_path / "my_effect.py"
    file.write_text(HYPOTHESIS.replace(good, bad))
    with pytest.raises(InputError) as caught:
        plugins.load(file)
    line = str(caught.value).splitlines()[0]
    assert line.startswith(f"{file}:")
    assert told in line
    if fault != "no effect":  # there is no line to name
        changed = next(i for i, text in enumerate(HYPOTHESIS.splitlines(), 1) if good.splitlines()[0] in text)
        declared = int(line.removeprefix(f"{file}:").split(":")[0])
        assert 0 <= changed - declared <= 10
    assert "quintic_stiffness" not in effects.EFFECTS
    assert "my_effect" not in sys.modules
    assert not plugins.loaded()


def test_name_of_file_is_free(tmp_path):
    (tmp_path / "json.py").write_text(HYPOTHESIS)
    with pytest.raises(InputError, match="rename the file"):
        plugins.load(tmp_path / "json.py")


def command(folder: Path, *words: str) -> None:
    small_sweep.ended("-m", "wedgesweep", *words, directory=folder)


@pytest.mark.acceptance
def test_hidden_effect_is_found_and_reported(tmp_path):
    """Synthesized with an effect of one's own, diagnosed with it: named, with equation, and it runs."""
    hidden = (REPOSITORY / "examples" / "shaker-hidden.toml").read_text()
    text = hidden.replace("[effects.cubic_stiffness]", "[effects.quintic_stiffness]")
    text = text.replace("coefficient_N_per_mm3 = 0.3", "force_N = 0.05")
    assert "force_N" in text
    (tmp_path / "hidden.toml").write_text(text)
    # Named as in the tutorial, so that its compiled code serves both.
    (tmp_path / "quintic_stiffness.py").write_text(HYPOTHESIS)
    tests = REPOSITORY / "examples" / "shaker-tests.toml"
    plugin = ("--plugin", "quintic_stiffness.py")
    made = ("--tests", str(tests), "-o", "made", "--n-jobs", "1")
    command(tmp_path, "synthesize", "hidden.toml", *plugin, *made)
    asked = ("--effects", "cubic_stiffness,quintic_stiffness")
    command(tmp_path, "diagnose", "made/measured.toml", *plugin, *asked, "-o", "found", "--n-jobs", "2")
    (cause,) = json.loads((tmp_path / "found" / "diagnosis.json").read_text())["causes"]
    low, high = cause["parameters"]["force_N"]["ci95"]
    assert cause["effect"] == "quintic_stiffness"
    assert low <= 0.05 <= high
    assert "fifth power of travel" in (tmp_path / "found" / "report.html").read_text()
    # Processes of a sweep know it.
    run = ("run", "found/extended.toml", *plugin, "--backend", "loky", "--n-jobs", "2")
    command(tmp_path, *run, "-o", "extended.nc")
    assert (xr.load_dataset(tmp_path / "extended.nc")["status"] == 0).all()
