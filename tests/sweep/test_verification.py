"""The judge finds a result that is wrong, and passes those that are right, of every kind of sweep."""

import shutil
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from tests.command import invoke
from wedgesweep.solvers import radau
from wedgesweep.solvers.trajectory import CaseError
from wedgesweep.sweep import batch, verification

CASES = """\
[sweep]
friction_law = ["coulomb", "exponential"]
beta = [0.4, 1.1]
amplitude_mm = [0.7, 1.0]
"""
SOLVERS = {
    "fixed": 'method = "event-driven"\nrtol = 1e-6\nsettle_periods = 2\n',
    "steady": 'method = "event-driven"\nsettle = "steady"\n',
    "continuation": 'method = "event-driven"\nsettle = "steady"\ncontinuation = true\n',
    "radau": "settle_periods = 4\n",
}
SHORT = "kept_periods = 2\nsamples_per_period = 32\nkeep_waveforms = false\n"
# Bristles: the state has a third number, without which a period would not begin where it ends.
BRISTLES = "[effects.presliding]\nlength_mm = 0.01\n"


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(solver, *options, cases=CASES, code=0):
    Path("c.toml").write_text(f"{cases}[solver]\n{solver}{SHORT}")
    return invoke("run", "c.toml", "--n-jobs", 1, *options, code=code)


@pytest.mark.few(1)
@pytest.mark.parametrize("kind", SOLVERS)
def test_right_results_pass(here, kind):
    told = run(SOLVERS[kind], "--verify", 1)
    assert "verified by Radau at rtol 1e-09: 1 case out of 8 that were solved (random, seed 0)" in told
    assert "largest difference of the amplitude ratio: " in told
    assert "differ by more" not in told


@pytest.mark.acceptance
def test_states_of_effects_are_begun_in_as_well(here):
    text = CASES.replace('["coulomb", "exponential"]', '"static-dynamic"').replace("[0.4, 1.1]", "1.1")
    told = run(SOLVERS["steady"], "--verify", 1, cases=BRISTLES + text)
    assert "differ by more" not in told


@pytest.fixture
def broken(monkeypatch):
    """An event-driven solver that gets friction wrong by a per cent: responses are a little too large."""
    right = batch._fill

    def wrong(records, solved, settings):
        solved.numbers["amplitude_ratio"] *= 1.01
        right(records, solved, settings)

    monkeypatch.setattr(batch, "_fill", wrong)


@pytest.mark.few(1)
@pytest.mark.parametrize("kind", ["steady", "fixed"])
def test_a_broken_solver_is_found(here, broken, kind):
    told = run(SOLVERS[kind], "--verify", 1, "--seed", 7, code=1)
    assert "seed 7" in told
    assert "1 of 1 cases differ by more" in told


@pytest.mark.acceptance
def test_a_finished_dataset_is_judged_as_it_is_stored(here):
    few = CASES.replace("[0.4, 1.1]", "1.1").replace("[0.7, 1.0]", "1.0")
    run(SOLVERS["fixed"], cases=few)
    ds = xr.load_dataset("c.nc")
    ds["stick_fraction"].loc["coulomb", 1.1, 1e-3] += 0.02
    ds.to_netcdf("other.nc")
    shutil.move("other.nc", "c.nc")
    told = run(SOLVERS["fixed"], "--verify", 2, cases=few, code=1)
    assert "already complete" in told
    assert "stick fraction: 0.02, at coulomb, beta 1.1, amplitude 1 mm" in told
    ds["amplitude_ratio"].loc["exponential", 1.1, 1e-3] = np.nan
    ds.to_netcdf("c.nc")
    assert "2 of 2 cases differ by more than" in run(SOLVERS["fixed"], "--verify", 2, cases=few, code=1)
    assert "1 of 2 cases differ by more than 0.001 of the amplitude ratio" in told


def test_a_motion_that_radau_itself_cannot_pin_down_is_not_judged(here, broken, monkeypatch):
    found = iter(np.linspace(0.5, 1.0, 20))
    monkeypatch.setattr(
        verification, "_solved", lambda task, rtol: verification.Numbers(float(next(found)), 0.0)
    )
    told = run(SOLVERS["fixed"], "--verify", 2, code=1)
    assert "verified by Radau at rtol 1e-09: 0 cases" in told
    assert "not verified: " in told
    assert "Radau moves by 0.03 itself from rtol 1e-09 to 1e-10" in told


def test_a_judge_that_fails_is_told(here, monkeypatch):
    def fails(*arguments):
        raise CaseError("gave up", "time_limit")

    run(SOLVERS["fixed"])
    monkeypatch.setattr(radau, "solve", fails)
    assert "not verified: " in (told := run(SOLVERS["fixed"], "--verify", 1, code=1))
    assert "Radau fails: gave up" in told


def test_very_many_cases_must_be_confirmed(here, monkeypatch):
    monkeypatch.setattr("wedgesweep.cli.summary.MANY", 7)
    told = run(SOLVERS["fixed"], code=2)
    for words in ("time: about", "memory: about", "dataset: at most", "8 cases are more than 7: --yes runs"):
        assert words in told
    assert not list(here.glob("c.nc*"))
    assert "8 ok" in run(SOLVERS["fixed"], "--yes")
    assert "already complete" in run(SOLVERS["fixed"])


def test_an_input_that_does_not_repeat_is_refused(here):
    config = Path(__file__).parents[2] / "configs" / "lugre.toml"
    assert "this input does not repeat" in invoke("run", config, "--verify", 2, code=2)
    assert not list(here.iterdir())
