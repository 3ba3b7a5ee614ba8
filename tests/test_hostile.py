"""Pipes, signals, full disks: one line says what is wrong, and nothing is lost."""

import os
import resource
import signal
import subprocess
import sys
import time

import pytest
import xarray as xr

from tests import fixture_diagnosis, fixture_measured, small_sweep
from tests.command import invoke
from tests.small_sweep import CONFIG
from wedgesweep import api, config, files
from wedgesweep.cli import failure
from wedgesweep.cli.diagnose import _move
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.simulate import Settings
from wedgesweep.sweep import cases

LONG = CONFIG.replace("settle_periods = 3", "settle_periods = 40")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "small.toml").write_text(CONFIG)
    fixture_measured.write(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("command", "file"),
    [
        (["check", "pipe"], "pipe"),
        (["run", "pipe"], "pipe"),
        (["check", "/dev/zero"], "/dev/zero"),
        (["check", "measured.toml"], "one.csv"),
        (["check", "measured.toml"], "model.toml"),
        (["check", "pipe.nc"], "pipe.nc"),
        (["status", "pipe.nc"], "pipe.nc"),
        (["plot", "all", "pipe.nc"], "pipe.nc"),
        (["run", "small.toml"], "small.nc.partial"),
        (["run", "small.toml", "--fresh"], "small.nc.partial"),
        (["run", "small.toml"], "small.nc"),
        (["status", "small.nc"], "small.nc.partial"),
        (["diagnose", "pipe"], "pipe"),
        (["synthesize", "small.toml", "--tests", "pipe"], "pipe"),
    ],
)
def test_a_pipe_or_device_is_refused_at_once(here, command, file):
    if not file.startswith("/"):
        (here / file).unlink(missing_ok=True)
        os.mkfifo(here / file)
    assert f"{file}: not a regular file" in invoke(*command, code=2)


@pytest.mark.parametrize(
    "command",
    [
        ["init", "out.toml", "--force"],
        ["schema", "-o", "out.toml"],
        ["case", "small.toml", "--beta", "1", "--amplitude", "1", "-o", "out.toml"],
        ["run", "small.toml", "-o", "out.toml"],
        ["plot", "friction-laws", "made.nc", "-o", "out.toml"],
    ],
)
def test_no_output_takes_the_place_of_a_pipe_or_device(here, command):
    """As root, ``-o /dev/null`` would leave a plain file there."""
    ending = {"init": "toml", "schema": "json", "case": "nc", "run": "nc", "plot": "png"}[command[0]]
    command = [word.replace("out.toml", f"out.{ending}") for word in command]
    invoke("run", "small.toml", "-o", "made.nc")
    os.mkfifo(here / f"out.{ending}")
    assert f"out.{ending}: not a regular file" in invoke(*command, code=2)
    assert (here / f"out.{ending}").is_fifo()


@pytest.mark.parametrize(
    "command", [["init", "a\0b"], ["run", "small.toml", "-o", "a\0b.nc"], ["status", "\0"], ["check", "a\0"]]
)
def test_a_null_character_in_an_argument(here, command):
    assert "cannot hold a null character" in invoke(*command, code=2)


@pytest.mark.parametrize("command", [["init"], ["status"], ["run", "small.toml", "-o"]])
def test_an_empty_path_is_not_the_current_directory(here, command):
    assert "an empty path" in invoke(*command, "", code=2)


@pytest.mark.parametrize("name", ["model.t", "one.c"])
def test_a_name_longer_than_a_system_takes(here, name):
    text = fixture_measured.MEASURED.replace(name, "a" * 5000 + name)
    (here / "measured.toml").write_text(text)
    told = invoke("check", "measured.toml", code=2)
    assert "measured.toml: measurement." in told
    assert "File name too long" in told
    assert max(map(len, told.splitlines())) < 500


def test_an_output_without_a_name(here):
    with pytest.raises(IsADirectoryError), files.written(files.Path()):
        pass


def test_attributes_of_the_wrong_kind(here):
    invoke("run", "small.toml", "-o", "made.nc")
    whole = xr.load_dataset("made.nc")
    for name, value in (("config", 3), ("omega_n", "x")):
        whole.assign_attrs({name: value}).to_netcdf("other.nc")
        said = invoke("plot", "friction-laws", "other.nc", code=2)
        assert f"other.nc: not the dataset of a sweep: its attribute {name}" in said


def test_whatever_netcdf4_raises_the_file_is_damaged(here, monkeypatch):
    """A file with a damaged dimension ended in an AttributeError of the library."""
    import netCDF4

    (here / "small.nc").write_bytes(b"\x89HDF\r\n\x1a\n")

    def raises(*arguments, **options):
        raise AttributeError("'NoneType' object has no attribute 'dimensions'")  # noqa: EM101

    monkeypatch.setattr(netCDF4, "Dataset", raises)
    assert "Error: small.nc: " in invoke("status", "small.nc", code=2)


def test_an_empty_file_is_replaced_where_that_is_asked_for(here):
    (here / "small.nc").touch()
    assert "small.nc: empty file; --fresh replaces it" in invoke("run", "small.toml", code=2)
    invoke("run", "small.toml", "--fresh")
    assert (here / "small.nc").stat().st_size > 0


def test_a_null_character_in_a_path(here):
    text = fixture_measured.MEASURED.replace("one.csv", "one\\u0000.csv").replace("model.t", "model\\u0000.t")
    (here / "measured.toml").write_text(text)
    told = invoke("check", "measured.toml", code=2)
    assert "measurement.model: " in told
    assert told.count("holds a null character") == 2
    with pytest.raises(OSError, match="null character"):
        files.regular(here / "x\0.csv")


@pytest.mark.parametrize("fresh", [(), ("--fresh",)])
@pytest.mark.parametrize("content", ["mine", "mine\n", "{}\n", '{"config": 1}\n'])
def test_a_foreign_file_in_place_of_the_journal_stays(here, content, fresh):
    (here / "small.nc.partial").write_text(content)
    assert "small.nc.partial: not the journal of a sweep" in invoke("run", "small.toml", *fresh, code=2)
    assert (here / "small.nc.partial").read_text() == content


def test_what_a_killed_process_left_is_removed_and_nothing_else(here):
    ended = subprocess.Popen(["true"])
    ended.wait()
    orphan, others = f".x.txt.{ended.pid}", [f".x.txt.{os.getppid()}", ".x.txt.bak", f".y.txt.{ended.pid}"]
    for name in (orphan, *others):
        (here / name).write_text("half")
    files.write_text(here / "x.txt", "whole")
    assert not (here / orphan).exists()
    assert all((here / name).exists() for name in others)
    assert (here / "x.txt").read_text() == "whole"


@pytest.mark.parametrize(("limit", "file"), [(4_000, "small.nc.partial"), (70_000, "small.nc")])
def test_a_full_disk_is_told_with_the_file_and_loses_nothing(here, limit, file):
    """A limit on the size of a file fails as a full disk does."""
    cases.compile_once(Settings("radau"))
    limited = subprocess.run(
        small_sweep.command("run", "small.toml", "--n-jobs", 1),
        env=small_sweep.environment(),
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
    )
    assert limited.returncode == 2, limited.stderr
    assert f"Error: {file}: " in limited.stderr
    assert "Traceback" not in limited.stderr
    assert not (here / "small.nc").exists()
    assert "24 ok" in invoke("run", "small.toml", "--n-jobs", 1)
    assert not list(here.glob(".small*"))


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_other_signals_end_a_run_as_ctrl_c_does(here, number):
    (here / "long.toml").write_text(LONG)
    process = small_sweep.start("run", "long.toml", "--n-jobs", 2, directory=here)
    journal = here / "long.nc.partial"
    while process.poll() is None and not (journal.exists() and journal.stat().st_size > 5000):
        time.sleep(0.01)
    # A terminal that closes tells all processes of the group, kill just one.
    (os.killpg if number == signal.SIGHUP else os.kill)(process.pid, number)
    told = process.communicate()[0]
    assert process.returncode == 128 + number, told
    assert "finished cases are stored in long.nc.partial; rerun the same command" in told
    assert "Traceback" not in told


def test_a_signal_ends_also_what_python_cannot_interrupt(here):
    """A command in compiled code does not hear of it; the loop stands for that."""
    code = (
        "import os, signal, time; from wedgesweep.cli import failure; failure.GRACE = 0.2;"
        "failure.end_on_signals()"
    )
    loop = """
began = time.monotonic()
while time.monotonic() < began + 60.0:
    try:
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(60.0)
    except KeyboardInterrupt:
        pass
"""
    ended = subprocess.run(
        [sys.executable, "-c", f"{code}\n{loop}"],
        env=small_sweep.environment(),
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 143
    assert "interrupted at once; rerun the same command to resume" in ended.stderr


def test_umlauts_where_the_locale_has_none(here):
    """The locale C knows ASCII only; files are UTF-8 all the same."""
    (here / "prüfstand.toml").write_text(CONFIG.replace('"small"', '"Prüfstand µ"'), encoding="utf-8")
    environment = small_sweep.environment(LC_ALL="C", PYTHONUTF8="0", PYTHONCOERCECLOCALE="0")
    for command in (("status", "prüfstand.nc"), ("check", "prüfstand.toml")):
        ended = subprocess.run(
            small_sweep.command(*command),
            env=environment,
            capture_output=True,
            check=False,
        )
        told = ended.stdout + ended.stderr
        assert ended.returncode == (2 if "status" in command else 0), told
        assert b"Traceback" not in told
        assert b"pr" in told


def test_a_cache_that_cannot_be_written_is_told_and_does_without(here):
    """A file stands where the folder should be: also root cannot make it."""
    (here / "file").write_text("")
    code = (
        "from wedgesweep import compiled; from wedgesweep.cli.compiling import announce_compiling;"
        "import logging, os; logging.basicConfig(level='INFO'); announce_compiling(); announce_compiling();"
        "print(compiled.CACHE_DIR.is_dir(), os.environ['NUMBA_CACHE_DIR'] == str(compiled.CACHE_DIR))"
    )
    ended = subprocess.run(
        [sys.executable, "-c", code],
        env=small_sweep.environment(NUMBA_CACHE_DIR=str(here / "file" / "cache")),
        capture_output=True,
        text=True,
        check=True,
    )
    assert ended.stdout == "True True\n"
    assert ended.stderr.count("cannot be written to: what is compiled is not kept") == 1


def test_a_hangup_that_is_ignored_stays_ignored():
    """Under nohup a run goes on when the terminal closes."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        failure.end_on_signals()
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_dataset_in_place_of_a_config_says_so(here):
    (here / "small.nc").write_bytes(b"\x89HDF\r\n\x1a\n")
    assert "small.nc: a dataset, where a config (TOML) is wanted" in invoke("run", "small.nc", code=2)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"title = 0x{'f' * 5000}\n", "title: 0xfff"),
        (f"title = {'[' * 3000}{']' * 3000}\n", "not valid TOML: nested more than 20 deep"),
        (f"a{'.a' * 3000} = 1\n", "not valid TOML: nested more than 20 deep"),
    ],
)
def test_absurd_toml_is_refused_in_a_line(here, text, words):
    (here / "x.toml").write_text(text + CONFIG.replace('title = "small"', ""))
    for command in ("check", "run"):
        assert f"x.toml: {words}" in invoke(command, "x.toml", code=2)


def test_many_listed_cases_are_read_in_a_moment(here):
    """Processor time (s) of an idle machine: 0.6."""
    cases = "".join(
        f'[[sweep.case]]\nfriction_law = "coulomb"\nbeta = {0.1 + 1e-4 * i:.4f}\namplitude_mm = 1.0\n'
        for i in range(20_000)
    )
    (here / "many.toml").write_text(cases)
    began = time.process_time()
    assert config.load(here / "many.toml").records().size == 20_000
    assert time.process_time() - began < 2.0
    (here / "many.toml").write_text(cases + cases[: cases.index("[[", 2)])
    assert "sweep.case[20000]: repeats sweep.case[0]; keep one" in invoke("check", "many.toml", code=2)


def test_a_foreign_report_in_the_place_of_a_diagnosis_stays(here):
    (here / "result").mkdir()
    (here / "result" / "report.html").write_text("mine")
    told = invoke("diagnose", "measured.toml", "-o", "result", code=2)
    assert "result/report.html: not the result of a diagnosis; choose another -o" in told
    assert (here / "result" / "report.html").read_text() == "mine"


def test_an_earlier_diagnosis_gives_way_to_a_complete_one_only(here):
    for name in ("made", "result"):
        (here / name).mkdir()
    for name in ("diagnosis.json", "report.html", "gain.png", "mine.txt"):
        (here / "result" / name).write_text("old")
    for name in ("diagnosis.json", "diagnosis.nc"):
        (here / "made" / name).write_text("new")
    _move(here / "made", here / "result")
    left = {path.name: path.read_text() for path in (here / "result").iterdir()}
    assert left == {"diagnosis.json": "new", "diagnosis.nc": "new", "mine.txt": "old"}


def test_a_diagnosis_leaves_its_result_and_nothing_else(here, monkeypatch):
    found = DiagnosisResult(*fixture_diagnosis.build(), "extended")
    monkeypatch.setattr(api, "diagnose_measurement", lambda *given, **more: found)
    (here / "cache").mkdir()
    monkeypatch.setattr(cases, "CACHE_DIR", here / "cache")
    before = set(here.iterdir())
    told = invoke("diagnose", "measured.toml", "--no-report", "-o", "results/first")
    assert "wrote results/first" in told
    assert set(here.iterdir()) - before == {here / "results"}
    assert [path.name for path in (here / "results").iterdir()] == ["first"]
    assert len(list((here / "results" / "first").iterdir())) == 3
