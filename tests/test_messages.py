"""What commands say beside their results: compilation, progress; --quiet and --verbose."""

import numpy as np
import pytest

from tests import small_sweep
from tests.command import invoke
from wedgesweep.cli import compiling, messages
from wedgesweep.cli.progress import ProgressReport
from wedgesweep.diagnose.work import Step

FEW = small_sweep.CONFIG.replace("1.1, ", "").replace("[solver]", '[solver]\nmethod = "event-driven"')
RUN = ("run", "few.toml", "--n-jobs", 1, "--fresh")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "few.toml").write_text(f"{FEW}\n[friction]\nstatic = 0.1\n")
    return tmp_path


@pytest.fixture
def clock(monkeypatch):
    """Seconds that pass where the test says so."""
    now = [0.0]
    monkeypatch.setattr("wedgesweep.cli.progress.perf_counter", lambda: now[0])
    monkeypatch.setattr(compiling, "perf_counter", lambda: now[0])
    return now


def lines(capfd):
    return capfd.readouterr().err.splitlines()


def test_quiet_leaves_the_result_and_verbose_tells_more(here):
    normal, quiet, verbose = (invoke(*RUN, *option) for option in ((), ("--quiet",), ("--verbose",)))
    for words in ("note: friction.static", "16/16 cases"):
        assert words in normal
        assert words not in quiet
        assert words in verbose
    assert "16 cases: 16 ok" in quiet
    assert "dataset: few.nc" in quiet
    for words in ("few.toml: 16 cases, event-driven", "few.nc.partial: 0 cases of an", "few.nc: written, "):
        assert words in verbose
        assert words not in normal
    assert invoke(*RUN) != quiet  # a command's choice is forgotten with it


def test_quiet_keeps_warnings_and_errors(here):
    invoke(*RUN, "--quiet")
    plot = ("plot", "response", "few.nc", "--quiet")
    assert "the nearest one there is" in invoke(*plot, "--beta", 0.31)
    assert "absent.toml: No such file" in invoke("check", "absent.toml", "--quiet", code=2)
    assert "contradict each other" in invoke(*plot, "--verbose", code=2)


def records(*statuses):
    return np.array([(status,) for status in statuses], [("status", "i1")])


def test_a_short_sweep_tells_only_its_end(capfd, clock):
    messages.begin()
    progress = ProgressReport()
    progress.cases(records(), 10)
    for _ in range(10):
        clock[0] += 0.05
        progress.cases(records(0), 10)
    assert lines(capfd) == ["10 cases", "10/10 cases, 0.5 s"]


def test_log_lines_tell_counts_failures_and_time_left(capfd, clock):
    messages.begin()
    progress = ProgressReport()
    for total, kept in ((40, 10), (20, 0)):
        progress.cases(records(*[0] * kept), total)
        for done in range(kept + 1, total + 1):
            clock[0] += 1.0
            progress.cases(records(int(done == kept + 1)), total)
    told = lines(capfd)
    assert told[0] == "40 cases, 10 of them from an earlier run"
    assert told[1].startswith("14/40 cases, 1 failed, ")
    assert told[1].endswith(" left")
    assert told[8].startswith("40/40 cases, 1 failed, ")
    assert told[9] == "20 cases"
    assert len(told) == 10 + 10


def report(stage, total, seconds, clock):
    progress = ProgressReport()
    clock[0] += 100.0
    progress.step(Step(stage, 0, total))
    for done in range(1, total + 1):
        clock[0] += seconds
        progress.step(Step(stage, done, total))
    progress.stop()
    progress.step("held-out tests")


def test_progress_of_a_diagnosis_as_log_lines(capfd, clock):
    messages.begin()
    report("single effects", 21, 0.5, clock)
    assert lines(capfd) == [
        "single effects: 0 of 21",
        *(f"single effects: {n} of 21, about {(21 - n) / 2:.1f} s left" for n in range(3, 21, 3)),
        "single effects: 21 of 21",
        "held-out tests",
    ]
    # Slow steps are told one by one.
    report("single effects", 21, 30.0, clock)
    told = lines(capfd)
    assert len(told) == 23
    assert told[7] == "single effects: 7 of 21, about 7 min left"


def test_time_left_leaves_out_what_was_compiled(capfd, clock, monkeypatch):
    messages.begin()
    monkeypatch.setattr(compiling, "_listener", compiling.listener(object))
    progress = ProgressReport()
    progress.step(Step("single effects", 0, 4))
    compiling._listener.on_start(None)
    clock[0] += 30.0
    compiling._listener.on_end(None)
    clock[0] += 2.0
    progress.step(Step("single effects", 1, 4))
    assert lines(capfd)[-1] == "single effects: 1 of 4, about 6.0 s left"


def test_progress_on_a_terminal_is_one_line_that_messages_leave_below_them(capfd, clock, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    messages.begin()
    report("single effects", 3, 2.0, clock)
    told = capfd.readouterr().err
    assert told.split("\r\x1b[2K") == [
        "",
        "single effects: 0 of 3",
        "single effects: 1 of 3, about 4.0 s left",
        "single effects: 2 of 3, about 2.0 s left",
        "single effects: 3 of 3",
        "held-out tests\n",
    ]
    messages.begin()
    messages.show_status("1 of 3")
    messages.log.warning("odd")
    assert capfd.readouterr().err == "\r\x1b[2K1 of 3\r\x1b[2Kodd\n1 of 3"


def test_compilation_is_announced_when_it_takes_long(capfd, clock):
    messages.begin()
    heard = compiling.listener(object)
    for seconds, expected in (
        (0.4, []),
        (0.7, [compiling.FIRST]),
        (5.0, []),
        (12.0, ["compiling, 18 s so far"]),
    ):
        heard.on_start(None)
        heard.on_start(None)  # a function inside another
        clock[0] += seconds
        heard.on_end(None)
        heard.on_end(None)
        assert lines(capfd) == expected
        clock[0] += 100.0  # what is not compilation does not count


def test_numba_tells_of_its_compilation(here, monkeypatch, capfd):
    import numba

    monkeypatch.setattr(compiling, "FIRST_AFTER", 0.0)
    monkeypatch.setattr(compiling, "_listener", None)
    from numba.core import event

    messages.begin()
    before = list(event._registered["numba:compile"])
    compiling.announce_compiling()
    numba.njit(lambda x: x + 1)(1)
    event._registered["numba:compile"][:] = before
    assert lines(capfd) == [compiling.FIRST]
