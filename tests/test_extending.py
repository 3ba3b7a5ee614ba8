"""The examples of docs/extending.md, taken from the page and run."""

import json
import os
import re
import sys
from pathlib import Path

import pytest
import xarray as xr

from tests import fixture_dataset, small_sweep
from wedgesweep import figures
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
