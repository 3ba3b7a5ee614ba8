"""Effects from files outside of the package: what is wrong with one, and runs in processes."""

import json
import sys
from pathlib import Path

import pytest
import xarray as xr

from tests import small_sweep
from tests.test_extending import REPOSITORY
from wedgesweep import effects, plugins
from wedgesweep.errors import InputError

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
