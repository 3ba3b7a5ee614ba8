"""A run that is interrupted or killed keeps what is finished, and goes on to the same bits."""

import os
import signal
import time

import xarray as xr

from tests import small_sweep
from tests.command import hang_limit, invoke
from tests.small_sweep import CASES, CONFIG, FAST, ROOT, assert_same_numbers
from wedgesweep.cli import failure
from wedgesweep.sweep import journal

LONG = CONFIG.replace("settle_periods = 3", "settle_periods = 40")


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
    (tmp_path / "long.toml").write_text(FAST)
    process = small_sweep.python(BLOCKED, directory=tmp_path)
    sweep, path = small_sweep.sweep(tmp_path, FAST), tmp_path / "long.nc.partial"
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
    process = small_sweep.python(code, directory=ROOT)
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


def test_killed_workers_and_all_it_goes_on_and_ends_with_the_same_bits(tmp_path):
    """The campaign of scripts/kill_campaign.py does so 200 times, at random moments."""
    (tmp_path / "c.toml").write_text(CONFIG)
    sweep = small_sweep.sweep(tmp_path)
    process = small_sweep.start("run", "c.toml", "-o", "small.nc", "--n-jobs", 2, directory=tmp_path)
    wait_for(process, sweep.journal_path, 3 * (sweep.dtype.itemsize + 4))
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    assert process.returncode == -signal.SIGKILL
    records = journal.read(sweep.journal_path, sweep.dtype)
    kept = dict(zip(records["index"].tolist(), records["wall_time"].tolist(), strict=True))
    assert 0 < len(kept) < CASES
    told = []
    ds = sweep.run(n_jobs=1, progress=lambda records, total: told.append((len(records), total)))
    assert told[0] == (len(kept), CASES)
    assert sum(count for count, _ in told) == CASES
    # Not computed again: even the wall times are those of the first time.
    assert [ds["wall_time"].values.ravel()[index] for index in kept] == list(kept.values())
    assert_same_numbers(xr.load_dataset(sweep.out), sweep.run_here())
    assert {path.name for path in tmp_path.iterdir()} <= {"c.toml", "small.nc"}
