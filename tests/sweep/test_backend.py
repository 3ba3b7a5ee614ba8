"""A Dask cluster gives the bits of the processes here, whatever becomes of its workers."""

import importlib.util
import os
import signal
from functools import partial
from unittest.mock import MagicMock

import numpy as np
import pytest
import xarray as xr

from tests import small_sweep
from tests.command import invoke
from tests.small_sweep import CASES, CONFIG, FAST, assert_same_numbers
from tests.sweep.test_transient_sweep import HEAD, SWEPT, TAIL
from wedgesweep.errors import MismatchError, SweepError
from wedgesweep.sweep import cluster as clusters
from wedgesweep.sweep import workers as workers_of_a_sweep

dask = pytest.importorskip("dask")
distributed = pytest.importorskip("distributed", reason="Dask is not installed")

# Long enough that a worker is at work when it is killed.
LONG = FAST.replace("settle_periods = 3", "settle_periods = 2000")
# An input that does not repeat.
MOVED = HEAD + SWEPT.replace("duration_s = 4.0", "duration_s = 1.0") + TAIL


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    return small_sweep.sweep(tmp_path_factory.mktemp("here"), LONG).run(n_jobs=1)


@pytest.fixture(scope="module")
def cluster():
    """Two worker processes, each started again by its nanny if it dies."""
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": ":0"}
    with distributed.LocalCluster(**options) as running, distributed.Client(running) as client:
        yield client


def through(client):
    return partial(clusters.dask, scheduler=client.scheduler.address)


def workers(client):
    """Process id of each worker that is there."""
    return set(client.run(os.getpid).values())


def test_a_cluster_that_is_left_while_a_worker_starts(monkeypatch):
    """Dask asserts then, on top of the signal that ended the run."""
    cluster, client = MagicMock(), MagicMock()
    cluster.__exit__.side_effect = AssertionError
    client.__enter__.return_value, client.__exit__.return_value = client, False
    client.run.side_effect = lambda function, **options: {"worker": function()}
    client.ncores.return_value = {"worker": 1}
    monkeypatch.setattr(distributed, "LocalCluster", lambda **options: cluster)
    monkeypatch.setattr(distributed, "Client", lambda *given, **options: client)
    with pytest.raises(KeyboardInterrupt), clusters.dask(1, dict):
        raise KeyboardInterrupt


def test_every_backend_gives_the_same_bits(tmp_path, monkeypatch):
    """Samples of an input are no part of the records, which hold their address only."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "few.toml").write_text(MOVED)
    for name, n_jobs in (("loky", 2), ("threads", 2), ("dask", 1)):
        command = ("run", "few.toml", "-o", f"{name}.nc", "--solver", "event-driven", "--backend", name)
        assert "6 cases: 6 ok" in invoke(*command, "--n-jobs", n_jobs, code=0)
    loky = xr.load_dataset("loky.nc")
    assert float(np.abs(loky["displacement"]).max()) > 0.0
    for name in ("threads", "dask"):
        assert_same_numbers(xr.load_dataset(f"{name}.nc"), loky)
    assert {path.name for path in tmp_path.iterdir()} == {"few.toml", "dask.nc", "loky.nc", "threads.nc"}


def test_workers_of_another_version_are_refused(tmp_path, cluster, monkeypatch):
    monkeypatch.setattr("wedgesweep.sweep.fingerprint.__version__", "99.0")
    words = r"would compute other numbers \(wedgesweep: .* there, 99\.0 now"
    with pytest.raises(SweepError, match=words) as caught:
        small_sweep.sweep(tmp_path).run(backend=through(cluster))
    # What is stored is not at fault: no advice to discard it.
    assert not isinstance(caught.value, MismatchError)
    assert not list(tmp_path.iterdir())


@pytest.mark.acceptance
def test_a_killed_worker_costs_its_chunk_only(tmp_path, expected, cluster):
    before, told = workers(cluster), []

    def kill_one(records, total):
        told.extend(records["index"].tolist())
        if len(told) == 5:
            os.kill(min(before), signal.SIGKILL)

    sweep = small_sweep.sweep(tmp_path, LONG)
    assert_same_numbers(sweep.run(backend=through(cluster), progress=kill_one), expected)
    assert sorted(told) == list(range(CASES))
    assert workers(cluster) != before
    assert [path.name for path in tmp_path.iterdir()] == ["small.nc"]


@pytest.mark.acceptance
def test_what_dask_gives_up_is_solved_again(tmp_path, expected):
    kept, remarks = [], []

    def kill_all(records, total):
        kept.extend(records["index"].tolist())
        if len(kept) == 5:
            for worker in workers(client):
                os.kill(worker, signal.SIGKILL)

    sweep = small_sweep.sweep(tmp_path, LONG)
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as running,
        distributed.Client(running) as client,
    ):
        found = sweep.run(backend=through(client), progress=kill_all, tell=remarks.append)
    assert_same_numbers(found, expected)
    assert remarks == [workers_of_a_sweep.TOLD]


def refused(directory, *arguments):
    """What is said when the run cannot start; the dataset that is there stays."""
    (directory / "small.toml").write_text(CONFIG)
    (directory / "small.nc").write_text("mine")
    output = directory / "small.nc"
    command = ("run", directory / "small.toml", "-o", output, "--fresh", "--backend", "dask")
    told = invoke(*command, *arguments, code=2)
    assert output.read_text() == "mine"
    assert not list(directory.glob("*.partial"))
    return told


@pytest.mark.parametrize("scheduler", ["tcp://127.0.0.1:9", "nonsense://there", "127.0.0.1"])
def test_no_scheduler(tmp_path, monkeypatch, scheduler):
    """Collected while another client starts, one that is not closed would wait for its lock forever."""
    monkeypatch.setattr(clusters, "TIMEOUT", 0.5)
    made = []
    init = distributed.Client.__init__
    monkeypatch.setattr(
        distributed.Client, "__init__", lambda own, *a, **k: (made.append((own, k)), init(own, *a, **k))[1]
    )
    told = refused(tmp_path, "--scheduler", scheduler)
    assert f"Error: {scheduler}: no Dask scheduler with a worker" in told
    assert [(client.status, options["timeout"]) for client, options in made] == [("closed", 0.5)]


@pytest.mark.acceptance
def test_a_scheduler_without_workers(tmp_path, monkeypatch):
    monkeypatch.setattr(clusters, "TIMEOUT", 1.0)
    with distributed.LocalCluster(n_workers=0, dashboard_address=":0") as cluster:
        told = refused(tmp_path, "--scheduler", cluster.scheduler_address)
    assert "no Dask scheduler with a worker" in told


def test_without_the_extra(tmp_path, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert "pip install 'wedgesweep[dask]'" in refused(tmp_path)


def test_options_that_contradict_each_other(tmp_path):
    told = refused(tmp_path, "--scheduler", "tcp://127.0.0.1:9", "--n-jobs", 2)
    assert "--n-jobs has no effect with --scheduler" in told
    told = refused(tmp_path, "--scheduler", "tcp://127.0.0.1:9", "--backend", "loky")
    assert "--scheduler needs --backend dask" in told
