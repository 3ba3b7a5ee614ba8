"""The Python API: the page about it runs as it stands, and says what the functions offer."""

import inspect
import json
import re
import shutil
from importlib import import_module
from pathlib import Path

import pytest
import xarray as xr

import wedgesweep as ws
from tests.small_sweep import CONFIG, FAST, LOCKED, assert_same_numbers
from wedgesweep import config
from wedgesweep.errors import InputError, MismatchError, SweepError

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "api.md").read_text()


@pytest.mark.acceptance
def test_the_page_runs(tmp_path, monkeypatch):
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    names = {}
    for block in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL):
        exec(block, names)
    assert names["ds"].sizes["beta"] == 5
    assert 0.0 < names["case"]["stick_fraction"].item() < 1.0
    assert all(ax.has_data() for ax in names["axes"])
    found = names["found"]
    assert (found.verdict, [cause["effect"] for cause in found.causes]) == ("named", ["fixture_resonance"])
    truth = json.loads((ROOT / "examples/bench/truth.json").read_text())["effects"]["fixture_resonance"]
    for key, number in found.causes[0]["parameters"].items():
        low, high = number["ci95"]
        assert low <= truth[key] <= high
    stored = {file.name for file in (tmp_path / "bench-diagnosis").iterdir()}
    assert stored == {"diagnosis.json", "diagnosis.nc", "extended.toml"}


@pytest.mark.parametrize("name", ws.__all__)
def test_every_function_is_on_the_page_documented_and_typed(name):
    function = getattr(ws, name)
    assert f"`ws.{name}(" in PAGE
    for section in ("Parameters", "Returns", "Raises"):
        assert re.search(rf"^{section}\n-+$", inspect.getdoc(function), re.MULTILINE), section
    parameters = inspect.signature(function).parameters.values()
    assert len(parameters) <= 7
    for parameter in parameters:
        assert parameter.annotation is not parameter.empty
        assert re.search(rf"\b{parameter.name}\b", inspect.getdoc(function))


def test_functions_stay_functions_when_the_modules_below_are_loaded():
    for module in ("sweep.run", "simulate", "diagnose.diagnosis", "cli"):
        import_module(f"wedgesweep.{module}")
    assert all(callable(getattr(ws, name)) for name in ws.__all__)
    assert set(ws.__all__) <= set(dir(ws))
    with pytest.raises(AttributeError, match="has no attribute 'absent'"):
        _ = ws.absent


def test_a_config_is_the_same_from_a_file_and_from_its_tables(tmp_path):
    (tmp_path / "small.toml").write_text(CONFIG)
    read = ws.load_config(tmp_path / "small.toml")
    assert ws.load_config(read.document).to_toml() == read.to_toml()
    with pytest.raises(InputError, match="betta"):
        ws.load_config({"sweep": {"betta": 1.0}})


def test_a_sweep_is_stored_and_resumed_or_left_in_memory(tmp_path):
    settings = config.parse(FAST)
    with pytest.raises(SweepError, match="end it in"):
        ws.run_sweep(settings, tmp_path / "small.png")
    ds = ws.run_sweep(settings, tmp_path / "small.nc", n_jobs=1)
    assert_same_numbers(ws.run_sweep(settings), ds)
    told = []
    again = ws.run_sweep(settings, tmp_path / "small.nc", progress=lambda records, total: told.append(total))
    assert told == []  # read, not run
    assert again["wall_time"].equals(ds["wall_time"])
    other = config.parse(FAST.replace("[0.02", "[0.03"))
    with pytest.raises(MismatchError, match=r"small\.nc: holds another sweep"):
        ws.run_sweep(other, tmp_path / "small.nc")
    assert ws.run_sweep(other, tmp_path / "small.nc", fresh=True)["amplitude"][0] == 3e-5


def test_a_case_is_that_of_the_sweep_and_a_failure_is_data(tmp_path):
    settings = config.parse(FAST)
    ds = ws.run_sweep(settings)
    case = ws.simulate_case(settings, law="exponential", beta=1.1, amplitude_mm=0.6)
    there = ds.sel(friction_law="exponential", beta=1.1, amplitude=0.6e-3)
    assert case["amplitude_ratio"].item() == there["amplitude_ratio"].item()
    assert isinstance(case, xr.Dataset)
    locked = ws.simulate_case(config.parse(LOCKED), beta=1.1, amplitude_mm=2.0)
    assert locked["status"].item() == 1
    assert "not unique" in locked["message"].item()
    for wrong in ({}, {"beta": 1.0, "frequency_hz": 8.0}, {"beta": -1.0}):
        with pytest.raises(InputError, match=r"sweep\.(beta|frequency_hz)"):
            ws.simulate_case(settings, amplitude_mm=1.0, **wrong)


def test_unknown_effects_and_figures_are_refused():
    measurement = ws.read_measurement(ROOT / "examples" / "bench" / "measured.toml")
    with pytest.raises(InputError, match='unknown effect stribek; did you mean "stribeck"'):
        ws.diagnose_measurement(measurement, effects=["stribek"])
    with pytest.raises(InputError, match=r"valid here: .*stribeck"):
        ws.diagnose_measurement(measurement, effects=[])
    with pytest.raises(ValueError, match="no figure 'stick-mop'"):
        ws.plot(xr.Dataset(), "stick-mop")


@pytest.mark.parametrize("n_jobs", [0, -1, 1.5, "x", True])
def test_a_wrong_number_of_jobs_is_named(n_jobs):
    with pytest.raises(SweepError, match="n_jobs"):
        ws.run_sweep(config.parse(FAST), n_jobs=n_jobs)
