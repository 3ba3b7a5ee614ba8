"""A sweep's numbers depend on its config alone: not on jobs, threads, kills or earlier runs."""

import os
import signal
import time
from collections import Counter

import numpy as np
import pytest
import xarray as xr

from tests import small_sweep
from tests.command import hang_limit, invoke
from tests.small_sweep import LOCKED, assert_same_numbers
from wedgesweep import config
from wedgesweep.cli import failure
from wedgesweep.response import Response
from wedgesweep.simulate import Settings
from wedgesweep.solvers.trajectory import CaseError
from wedgesweep.sweep import cases
from wedgesweep.sweep.variables import STATUSES

CONFIG = small_sweep.CONFIG.replace("0.3, 1.1, 2.5", "1.1").replace(
    "settle_periods = 3", "settle_periods = 1"
)
CASES = 8
TIMED_OUT = STATUSES.index("time_limit")


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """Sweep that was run undisturbed in this process, and its dataset as stored."""
    sweep = small_sweep.sweep(tmp_path_factory.mktemp("undisturbed"), CONFIG)
    sweep.run(n_jobs=1)
    return sweep, xr.load_dataset(sweep.out)


@pytest.fixture
def solved(monkeypatch):
    """Count how often each case is solved in this process, by its amplitude and frequency."""
    counts = Counter()
    original = cases.simulate.respond

    def counting(case, *arguments):
        counts[case["friction"]["law"][0], case["input"]["omega"][0], case["input"]["amplitude"][0]] += 1
        return original(case, *arguments)

    monkeypatch.setattr(cases.simulate, "respond", counting)
    return counts


def test_all_cases_are_solved_and_labelled(finished):
    sweep, ds = finished
    assert ds["status"].shape == (2, 1, 4)
    assert (ds["status"] == 0).all()
    for index, case in enumerate(sweep.config.case_list()):
        if index % 3 == 0:
            alone = sweep.solve(np.array([index]))[0]
            at = {"friction_law": case.law, "beta": case.beta, "amplitude": case.amplitude}
            assert ds["amplitude_ratio"].sel(at).item() == alone["amplitude_ratio"]
            assert ds["displacement"].sel(at).values.tolist() == alone["displacement"].tolist()
    assert not sweep.journal_path.exists()
    assert list(sweep.out.parent.iterdir()) == [sweep.out]


@pytest.mark.acceptance
def test_threads_of_numpys_libraries_change_no_bit(finished, tmp_path):
    code = (
        "from pathlib import Path; from tests import small_sweep; import numpy as np;"
        "from tests.sweep.test_run import CONFIG;"
        "records = small_sweep.sweep(Path(), CONFIG).solve(np.arange(0, 8, 2));"
        "records['wall_time'] = 0; Path('records').write_bytes(records.tobytes())"
    )
    found = set()
    for threads in ("1", "4"):
        names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
        small_sweep.ended("-c", code, directory=tmp_path, **dict.fromkeys(names, threads))
        found.add((tmp_path / "records").read_bytes())
    assert len(found) == 1
    records = np.frombuffer(found.pop(), finished[0].dtype)
    ratios = finished[1]["amplitude_ratio"].values.ravel()
    assert records["amplitude_ratio"].tolist() == ratios[::2].tolist()


def interrupted(sweep, after):
    """Run the sweep and stop it as ctrl-C would when some cases are finished."""
    done = []

    def stop(records, total):
        done.append(len(records))
        if sum(done) >= after:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep.run(n_jobs=1, progress=stop)
    return sum(done)


def test_no_case_is_solved_twice_but_one_whose_record_is_torn(tmp_path, finished, solved):
    sweep = small_sweep.sweep(tmp_path, CONFIG)
    assert interrupted(sweep, 3) == 3
    assert interrupted(sweep, 6) == 6
    sweep.journal_path.write_bytes(sweep.journal_path.read_bytes()[:-100])
    assert_same_numbers(sweep.run(n_jobs=1), finished[1])
    assert sorted(solved.values()) == [1] * (CASES - 1) + [2]


def test_cases_out_of_time_are_tried_again(tmp_path, finished):
    sweep = small_sweep.sweep(tmp_path, CONFIG)
    hurried = interrupted_when_all_timed_out(sweep)
    assert_same_numbers(sweep.run(n_jobs=1), finished[1])
    assert hurried["message"][hurried["status"] == TIMED_OUT][0].startswith(b"gave up after")


def interrupted_when_all_timed_out(sweep):
    told = []

    def stop(records, total):
        told.append(records)
        if sum(map(len, told)) == total:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep.run(n_jobs=1, case_timeout=1e-6, progress=stop)
    records = np.concatenate(told)
    assert set(records["status"]) <= {0, TIMED_OUT}  # what never slips needs no time
    assert (records["status"] == TIMED_OUT).sum() > CASES / 2
    return records


@pytest.mark.parametrize(
    ("error", "status", "words"),
    [
        (CaseError("state not finite", "not_finite"), "not_finite", "state not finite"),
        (ZeroDivisionError("by zero"), "solver_failure", "ZeroDivisionError: by zero"),
        (CaseError("ü" * 300, "solver_failure"), "solver_failure", "üüü"),
    ],
)
def test_whatever_a_case_raises_is_data(tmp_path, monkeypatch, error, status, words):
    def fails(*arguments):
        raise error

    monkeypatch.setattr(cases.simulate, "respond", fails)
    sweep = small_sweep.sweep(tmp_path, LOCKED)
    ds = sweep.run_here()
    assert {STATUSES[value] for value in ds["status"].values.ravel()} == {status}
    assert ds["message"].values.ravel()[0].startswith(words)
    ds.to_netcdf(tmp_path / "messages.nc")


def test_a_failure_half_way_leaves_no_numbers(tmp_path, monkeypatch):
    half = Response({"amplitude_ratio": 1.0}, {"displacement_harmonics": np.zeros(5)}, {})
    monkeypatch.setattr(cases.simulate, "respond", lambda *arguments: (half, {"steps": 3}))
    record = small_sweep.sweep(tmp_path).solve(np.array([0]))[0]
    assert STATUSES[record["status"]] == "solver_failure"
    assert np.isnan(record["amplitude_ratio"])

    half.numbers["amplitude_ratio"] = np.nan
    record = small_sweep.sweep(tmp_path).solve(np.array([0]))[0]
    assert STATUSES[record["status"]] == "not_finite"


def test_compiles_before_the_jobs_start(tmp_path, monkeypatch, solved):
    monkeypatch.setattr(cases.kernels, "folder", lambda: tmp_path)
    assert not cases.is_compiled(Settings("radau"))
    for _ in range(2):
        cases.compile_once(Settings("radau"))
        assert cases.is_compiled(Settings("radau"))
    assert sum(solved.values()) == 1


@pytest.mark.parametrize("method", ["event-driven", pytest.param("radau", marks=pytest.mark.acceptance)])
def test_the_short_run_of_a_motion_succeeds(method):
    own = "[oscillator]\nmass_kg = 2.0\nspring_N_per_mm = 0.8\nnormal_force_N = 4.0\n"
    release = '[input]\nkind = "release"\ndisplacement_mm = 3.0\nduration_s = 1.0\n'
    grid = f'[sweep]\nfriction_law = "coulomb"\nscale = 1.0\n[solver]\nmethod = "{method}"\n'
    given = config.parse(own + release + grid)
    short, dtype = cases.short_run(given.solver)
    (record,) = cases.solve_cases(given.records(np.array([0])), np.array([0]), short, 60.0, dtype)
    assert STATUSES[record["status"]] == "ok", record["message"]


LONG = small_sweep.CONFIG.replace("settle_periods = 3", "settle_periods = 40")


def ended(process, number):
    """What a process says that a signal of this number ends, and that leaves its finished cases."""
    told = process.communicate(timeout=hang_limit())[0]
    assert process.returncode == 128 + number, told
    assert "finished cases are stored in long.nc.partial; rerun the same command" in told
    assert "Traceback" not in told
    return told


def wait_for(process, path, size):
    """Wait until a file of a running process is that large (bytes)."""
    while process.poll() is None and not (path.exists() and path.stat().st_size >= size):
        time.sleep(0.005)


@pytest.mark.acceptance
def test_ctrl_c_while_jobs_start(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "long.toml").write_text(LONG)
    process = small_sweep.start("run", "long.toml", "--n-jobs", 2, directory=tmp_path)
    while process.stdout.readline().strip() != "24 cases":
        assert process.poll() is None
    time.sleep(0.3)  # by then jobs that do not ignore it are importing: they would print tracebacks
    os.killpg(process.pid, signal.SIGINT)
    ended(process, signal.SIGINT)
    assert "remaining" in invoke("status", "long.nc")


# Threads in which all cases but the first four take for ever. Compiled code does not hear of a signal.
BLOCKED = """
import sys, threading
from wedgesweep.__main__ import main
from wedgesweep.cli import failure
from wedgesweep.sweep import cases
solve_cases = cases.solve_cases
def solve_or_block(records, indices, *others):
    if indices[0] > 3:
        threading.Event().wait()
    return solve_cases(records, indices, *others)
cases.solve_cases, failure.GRACE = solve_or_block, 1e6
sys.argv = "wedgesweep run long.toml --n-jobs 2".split()
main()
"""


def test_a_case_that_is_being_solved_is_not_waited_for(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "long.toml").write_text(small_sweep.FAST)
    process = small_sweep.python(BLOCKED, directory=tmp_path)
    sweep, path = small_sweep.sweep(tmp_path, small_sweep.FAST), tmp_path / "long.nc.partial"
    wait_for(process, path, 4 * (sweep.dtype.itemsize + 4))
    os.killpg(process.pid, signal.SIGHUP)  # as a terminal that closes does
    ended(process, signal.SIGHUP)
    assert "cases are there" in invoke("plot", "peak-to-peak", "long.nc")
    assert "from an earlier run" in invoke("run", "long.toml", "--n-jobs", 2)
    assert_same_numbers(xr.load_dataset("long.nc"), sweep.run_here())


def test_a_signal_ends_also_what_python_cannot_interrupt():
    """A command in compiled code does not hear of it; the loop stands for that."""
    code = """
import os, signal, time
from wedgesweep.cli import failure
failure.GRACE = 0.2
failure.end_on_signals()
while True:
    try:
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(60.0)
    except KeyboardInterrupt:
        pass
"""
    process = small_sweep.python(code, directory=small_sweep.ROOT)
    told = process.communicate(timeout=hang_limit())[0]
    assert process.returncode == 143
    assert "interrupted at once; rerun the same command to resume" in told


def test_a_hangup_that_is_ignored_stays_ignored():
    """Under nohup a run goes on when the terminal closes."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        failure.end_on_signals()
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)
