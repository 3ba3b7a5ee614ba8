"""A worker that dies is replaced; a case that kills every worker fails, and the others are solved."""

import os
import signal
from functools import partial

import numpy as np
import pytest
import xarray as xr
from joblib.externals.loky import reusable_executor

from tests import small_sweep
from tests.small_sweep import CASES, FAST, assert_same_numbers
from tests.sweep.deadly import Task, deadly
from wedgesweep.errors import SweepError
from wedgesweep.outcome import Outcome
from wedgesweep.sweep import backend, workers
from wedgesweep.sweep.cases import solve_cases
from wedgesweep.sweep.journal import Journal
from wedgesweep.sweep.workers import Workers


def solved(cases, size, task):
    """Records of cases (n, width), in rows that are solved in chunks of some size, in order."""
    told, width = [], cases.shape[1]
    with backend.loky(2, dict) as pool:
        pool = Workers(
            pool,
            lambda left: (np.array(left[i : i + size]) for i in range(0, len(left), size)),
            lambda part: Task(cases[part].ravel()),
            lambda indices: indices // width,
            told.append,
            task,
        )
        records = np.concatenate(list(pool.solve(range(len(cases)))))
    assert len(told) == 1
    return records[np.argsort(records["index"])]


@pytest.mark.few(1)
@pytest.mark.parametrize(("width", "size"), [(1, 1), (1, 5), (3, 2)])
def test_a_deadly_case_fails_and_no_other(width, size):
    cases = np.arange(18).reshape(-1, width)
    records = solved(cases, size, partial(deadly, wrong=[7]))
    assert records["index"].tolist() == list(range(18))
    lost = {7} if width == 1 else {6, 7, 8}  # cases of a row depend on each other
    assert set(np.flatnonzero(records["status"] == Outcome.WORKER_LOST)) == lost
    assert set(np.flatnonzero(records["status"] == Outcome.OK)) == set(range(18)) - lost
    assert b"died in each of 2 tries" in records["message"][7]


def test_a_worker_that_dies_once_costs_no_case(tmp_path):
    records = solved(np.arange(12)[:, None], 2, partial(deadly, wrong=[4], once=tmp_path / "died"))
    assert records["index"].tolist() == list(range(12))
    assert (records["status"] == Outcome.OK).all()


def test_it_gives_up_where_workers_die_of_something_else(monkeypatch):
    monkeypatch.setattr(workers, "MOST_LOSSES", 0)
    with pytest.raises(SweepError, match=r"workers keep dying.*rerun the same command"):
        solved(np.arange(4)[:, None], 1, partial(deadly, wrong=[0]))


@pytest.mark.acceptance
def test_a_sweep_goes_on_with_the_same_bits(tmp_path):
    """Killed from outside while it solves."""
    told, killed, remarks = [], [], []

    def kill(records, total):
        told.extend(records["index"].tolist())
        if not killed and len(told) > 3:
            killed.append(min(reusable_executor._executor._processes))
            os.kill(killed[-1], signal.SIGKILL)

    sweep = small_sweep.sweep(tmp_path, FAST)
    sweep.run(n_jobs=2, backend=backend.loky, progress=kill, tell=remarks.append)
    expected = sweep.solve(np.arange(CASES))
    assert sorted(told) == list(range(CASES))
    assert remarks == [workers.TOLD]
    assert killed
    found = xr.load_dataset(sweep.out)
    assert found["amplitude_ratio"].values.ravel().tolist() == expected["amplitude_ratio"].tolist()
    assert_same_numbers(found, sweep.run_here())
    assert [path.name for path in tmp_path.iterdir()] == ["small.nc"]


def test_what_a_lost_worker_leaves_is_solved_by_the_next_run(tmp_path, monkeypatch):
    sweep = small_sweep.sweep(tmp_path, FAST)
    few = np.arange(2)
    records = solve_cases(sweep.config.records(few), few, sweep.settings, np.inf, sweep.dtype)
    records["status"][1] = Outcome.WORKER_LOST
    with Journal(sweep.journal_path, sweep.dtype, sweep.journal_header) as kept:
        kept.append(records)
    told = []
    sweep.run(n_jobs=1, progress=lambda part, total: told.append(part["index"].tolist()))
    assert told[0] == [0]
    assert [1] in told
