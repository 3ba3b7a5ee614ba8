"""Sweeps up and down in beta: responses that coexist are found, and each of them is a steady state."""

from math import inf
from pathlib import Path

import numpy as np
import pytest

from tests import small_sweep
from tests.command import invoke
from tests.small_sweep import LOCKED, assert_same_numbers
from wedgesweep import response
from wedgesweep.solvers import radau
from wedgesweep.solvers.trajectory import Window
from wedgesweep.sweep import batch, chunks, continuation, dataset, journal, variables
from wedgesweep.sweep.variables import DISTINCT, STATUSES

CONTINUED = {variable.name for variable in variables.CONTINUED}
# Friction that falls steeply: below 0.05 mm there is a motion over two periods beside one over a single one.
STEEP = """\
title = "friction that falls steeply"
[friction]
dynamic = 0.1
static = 0.6
[sweep]
friction_law = ["static-dynamic", "exponential"]
beta = { start = 2.2, stop = 2.9, num = 8 }
amplitude_mm = [0.0311, 0.2]
[solver]
method = "event-driven"
settle = "steady"
continuation = true
steady_tolerance = 1e-9
kept_periods = 2
samples_per_period = 32
"""
CASES = 32
# With the friction of Table 1 and away from breakaway a response does not depend on where it began.
TABLE_1 = STEEP[STEEP.index("[sweep]") :].replace("[0.0311, 0.2]", "[0.1, 1.0]").replace("2.2", "0.9")


def run(directory, text=STEEP, **options):
    return small_sweep.sweep(directory, text).run(**{"n_jobs": 1, "fresh": True, **options})


@pytest.fixture(scope="module")
def steep(tmp_path_factory):
    return run(tmp_path_factory.mktemp("steep"))


def test_finds_two_responses_at_the_same_input(steep):
    """Motion over two forcing periods on the way up beside an equally steady one over a single period."""
    assert (steep["coexisting"].isel(amplitude=1) == 0).all()
    small = steep.isel(amplitude=0)
    for law in steep["friction_law"].values:
        here = small.sel(friction_law=law)
        both = here["coexisting"] == 1
        assert both.sum() >= 2
        assert (here["period"].where(both, 2) == 2).all()
        assert (here["period_down"].where(both, 1) == 1).all()
        assert (abs(here["amplitude_ratio"] - here["amplitude_ratio_down"]).where(both, 1.0) > 0.5).all()


def test_one_response_is_found_from_both_sides(steep, tmp_path):
    table_1 = run(tmp_path, TABLE_1)
    assert (table_1["coexisting"] == 0).all()
    for ds in (steep, table_1):
        same = ds["coexisting"] == 0
        apart = abs(ds["amplitude_ratio"] - ds["amplitude_ratio_down"]).where(same, 0.0)
        # Far below the limit of the flag, which therefore tells safely.
        assert float(apart.max()) < 0.1 * DISTINCT * 1e-9
        assert (ds["period"] == ds["period_down"]).where(same, True).all()


def test_without_coexistence_the_numbers_are_those_from_rest(tmp_path):
    up = run(tmp_path, TABLE_1)
    alone = run(tmp_path, TABLE_1.replace("continuation = true", "continuation = false"))
    assert set(up) - set(alone) == CONTINUED
    for name in ("amplitude_ratio", "peak_to_peak", "dissipated_energy", "stick_fraction"):
        assert up[name].values == pytest.approx(alone[name].values, rel=1e-6, abs=1e-9), name


def restarted(case, state, period):
    """Ratio after a state and how far the state has moved, over input amplitude and velocity, by Radau."""
    window = Window(float(case["input"]["omega"][0]), 2 * period, period, 64)
    run = radau.solve(case, window, 1e-9, inf, tuple(state))
    scale = case["input"]["amplitude"][0] * np.array([1.0, case["input"]["omega"][0]])
    after = np.array([run.samples.x[0], run.samples.velocity[0]])
    return response.evaluate(run, case, 9).numbers["amplitude_ratio"], (after - state) / scale


@pytest.mark.acceptance
def test_both_sides_are_steady_states(tmp_path, steep):
    swept = small_sweep.sweep(tmp_path, STEEP)
    line = swept.rows.cases(np.array([0]))[0]
    both = continuation.up_and_down(line)
    found, ends = batch.solve_batch(
        swept.config.records()[both], both, swept.settings, swept.dtype, continuation=True
    )
    (up, down), (states, back) = np.split(found, 2), np.split(ends, 2)
    stored = steep.isel(friction_law=0, amplitude=0)
    assert stored["amplitude_ratio"].values.tolist() == up["amplitude_ratio"].tolist()
    assert stored["amplitude_ratio_down"].values.tolist() == down["amplitude_ratio"][::-1].tolist()
    # The way down begins in a steady state: it need not settle.
    assert down["settled_periods"][0] <= 2 * down["period"][0]
    for place in np.flatnonzero(stored["coexisting"].values == 1).tolist():
        for records, ends, at in ((up, states, place), (down, back, -1 - place)):
            case = swept.config.records()[line[place] : line[place] + 1]
            ratio, moved = restarted(case, ends[at][:2], int(records["period"][at]))
            assert ratio == pytest.approx(records["amplitude_ratio"][at], abs=1e-6)
            assert np.abs(moved).max() < 1e-6


def test_the_way_down_begins_in_the_whole_state_of_the_way_up(tmp_path):
    """Bristles and columns have states of their own, and a response over two periods is one there, too."""
    effects = "[effects.presliding]\nlength_mm = 0.002\n"
    swept = small_sweep.sweep(tmp_path, STEEP.replace("[0.0311, 0.2]", "0.0311") + effects)
    ds = swept.run(n_jobs=1)
    top = ds.isel(beta=-1, amplitude=0)
    assert (top["coexisting"] == 0).all()
    assert (top["period"] == top["period_down"]).all()
    line = swept.rows.cases(np.array([0]))[0]
    both = continuation.up_and_down(line)
    found, _ = batch.solve_batch(
        swept.config.records()[both], both, swept.settings, swept.dtype, continuation=True
    )
    assert found["settled_periods"][line.size] <= 2 * found["period"][line.size]


def test_a_line_follows_its_neighbours_and_no_other_line(steep, tmp_path):
    swept = small_sweep.sweep(tmp_path, STEEP)
    lines = swept.rows.cases(np.arange(swept.rows.count))
    assert lines.shape == (4, 8)
    assert (np.diff(swept.config.records()["input"]["omega"][lines], axis=1) > 0.0).all()
    mixed = np.random.default_rng(1).permutation(np.concatenate([lines[2], lines[0]]))
    records = np.sort(swept.solve(mixed), order="index")
    for name in (
        "amplitude_ratio",
        "amplitude_ratio_down",
        "period_down",
        "coexisting",
        "velocity_harmonics",
    ):
        expected = steep[name].values[:, :, 0]
        assert np.array_equal(records[name].reshape(expected.shape), expected), name


@pytest.mark.few(1)
@pytest.mark.parametrize(("chunk", "n_jobs"), [(1, 1), (20, 1), (200, 2)])
def test_chunks_and_jobs_change_no_bit(tmp_path, monkeypatch, steep, chunk, n_jobs):
    monkeypatch.setattr(chunks, "CHUNK", chunk)
    monkeypatch.setattr(chunks, "CHUNKS", 1)
    told = []
    ds = run(tmp_path, n_jobs=n_jobs, progress=lambda records, total: told.append(len(records)))
    assert_same_numbers(ds, steep)
    assert max(told) == {1: 8, 20: 16, 200: 32}[chunk]


def test_a_torn_line_is_solved_again_as_a_whole(tmp_path, monkeypatch, steep):
    swept, told = small_sweep.sweep(tmp_path, STEEP), []

    def stop(records, total):
        told.append(len(records))
        if sum(told) == 24:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        swept.run(n_jobs=1, progress=stop)
    swept.journal_path.write_bytes(swept.journal_path.read_bytes()[:-100])
    assert len(journal.read(swept.journal_path, swept.dtype)) == 23
    told.clear()
    ds = swept.run(n_jobs=1, progress=lambda records, total: told.append(len(records)))
    assert told == [16, 8, 8]
    assert_same_numbers(ds, steep)


def test_what_does_not_repeat_is_not_compared(tmp_path):
    ds = run(tmp_path, STEEP + "max_periods = 16\n")
    late = (ds["period"] == 0) | (ds["period_down"] == 0)
    assert 0 < late.sum() < CASES
    assert (ds["coexisting"].where(late, -1) == -1).all()
    assert (ds["coexisting"].where(~late, 0) >= 0).all()


def test_behind_a_case_that_fails_comes_rest(tmp_path):
    steady = 'method = "event-driven"\nsettle = "steady"\ncontinuation = true'
    text = LOCKED.replace("beta = 1.1", "beta = [0.3, 1.1, 1.2]").replace("settle_periods = 3", steady)
    ds = run(tmp_path, text).sel(friction_law="exponential").squeeze()
    assert [STATUSES[status] for status in ds["status"].values] == ["ok", "locked", "locked"]
    assert ds["coexisting"].values.tolist() == [0, -1, -1]
    assert ds["period_down"].values.tolist() == [ds["period"].values[0], -1, -1]
    assert np.isnan(ds["amplitude_ratio_down"].values[1:]).all()


@pytest.mark.usefixtures("empty_pictures")
def test_figures_and_the_command_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("c.toml").write_text(STEEP)
    invoke("run", "c.toml", "--n-jobs", 1)
    invoke("plot", "all", "c.nc", "-o", "figures")
    assert len(list(Path("figures").iterdir())) >= 5
    # One case has no neighbours: it runs from rest.
    invoke("case", "c.toml", "--beta", 2.5, "--amplitude", 0.0311, "-o", "one")
    assert not CONTINUED & set(dataset.read(Path("one.nc")))
    assert "solver.continuation" in invoke("run", "c.toml", "--solver", "radau", code=2)
