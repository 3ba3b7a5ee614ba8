"""Pipes, signals, full disks: one line says what is wrong, and nothing is lost."""

import os
import resource
import subprocess

import pytest
from click.testing import CliRunner

from tests import fixture_dataset, fixture_diagnosis, fixture_measured, small_sweep
from tests.command import invoke, python_calls
from tests.small_sweep import CONFIG, FAST
from wedgesweep import api, config, files
from wedgesweep.cli import cli
from wedgesweep.cli.diagnose import _move
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.processes import apart
from wedgesweep.simulate import Settings
from wedgesweep.sweep import cases


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "small.toml").write_text(CONFIG)
    fixture_measured.write(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("command", "file"),
    [
        ("check pipe", "pipe"),
        ("run /dev/zero", "/dev/zero"),
        ("check measured.toml", "one.csv"),
        ("check measured.toml", "model.toml"),
        ("check pipe.nc", "pipe.nc"),
        ("status pipe.nc", "pipe.nc"),
        ("plot all pipe.nc", "pipe.nc"),
        ("run small.toml", "small.nc.partial"),
        ("run small.toml --fresh", "small.nc.partial"),
        ("run small.toml", "small.nc"),
        ("status small.nc", "small.nc.partial"),
        ("diagnose pipe", "pipe"),
        ("synthesize small.toml --tests pipe", "pipe"),
        # As root, ``-o /dev/null`` would leave a plain file there.
        ("init out.toml --force", "out.toml"),
        ("schema -o out.json", "out.json"),
        ("case small.toml --beta 1 --amplitude 1 -o out.nc", "out.nc"),
        ("run small.toml -o out.nc", "out.nc"),
        ("plot friction-laws made.nc -o out.png", "out.png"),
    ],
)
def test_a_pipe_or_device_is_neither_read_nor_replaced(here, command, file):
    if "made.nc" in command:
        fixture_dataset.build().to_netcdf("made.nc")
    if not file.startswith("/"):
        (here / file).unlink(missing_ok=True)
        os.mkfifo(here / file)
    assert f"{file}: not a regular file" in invoke(*command.split(), code=2)
    assert file.startswith("/") or (here / file).is_fifo()


def test_null_characters_and_empty_paths(here):
    for command in (
        ["init", "a\0b"],
        ["run", "small.toml", "-o", "a\0b.nc"],
        ["status", "\0"],
        ["check", "a\0"],
    ):
        assert "cannot hold a null character" in invoke(*command, code=2)
    for command in (["init"], ["status"], ["run", "small.toml", "-o"]):
        assert "an empty path" in invoke(*command, "", code=2)
    with pytest.raises(IsADirectoryError), files.written(files.Path()):
        pass
    text = fixture_measured.MEASURED.replace("one.csv", "one\\u0000.csv").replace("model.t", "model\\u0000.t")
    (here / "measured.toml").write_text(text)
    told = invoke("check", "measured.toml", code=2)
    assert "measurement.model: " in told
    assert told.count("holds a null character") == 2
    with pytest.raises(OSError, match="null character"):
        files.regular(here / "x\0.csv")


@pytest.mark.parametrize("name", ["model.t", "one.c"])
def test_a_name_longer_than_a_system_takes(here, name):
    text = fixture_measured.MEASURED.replace(name, "a" * 5000 + name)
    (here / "measured.toml").write_text(text)
    told = invoke("check", "measured.toml", code=2)
    assert "measured.toml: measurement." in told
    assert "File name too long" in told
    assert max(map(len, told.splitlines())) < 500


def test_datasets_that_are_damaged_or_of_another_program(here, monkeypatch):
    whole = fixture_dataset.build()
    for name, value in (("config", 3), ("omega_n", "x")):
        whole.assign_attrs({name: value}).to_netcdf("other.nc")
        said = invoke("plot", "friction-laws", "other.nc", code=2)
        assert f"other.nc: not the dataset of a sweep: its attribute {name}" in said
    # A file with a damaged dimension ended in an AttributeError of the library.
    import netCDF4

    (here / "small.nc").write_bytes(b"\x89HDF\r\n\x1a\n")

    def raises(*arguments, **options):
        raise AttributeError("'NoneType' object has no attribute 'dimensions'")

    monkeypatch.setattr(netCDF4, "Dataset", raises)
    assert "Error: small.nc: " in invoke("status", "small.nc", code=2)


def test_an_empty_file_is_replaced_where_that_is_asked_for(here):
    (here / "small.toml").write_text(FAST)
    (here / "small.nc").touch()
    assert "small.nc: empty file; run --fresh replaces it" in invoke("run", "small.toml", code=2)
    invoke("run", "small.toml", "--fresh", "--n-jobs", 1)
    assert (here / "small.nc").stat().st_size > 0


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


def limited(size: int) -> tuple[int, str]:
    """Exit code and output of a run in a process whose files end at a size (bytes), as on a full disk."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    result = CliRunner().invoke(cli, ["run", "small.toml", "--n-jobs", "1"])
    return result.exit_code, result.output


@pytest.mark.parametrize(("limit", "file"), [(4_000, "small.nc.partial"), (70_000, "small.nc")])
def test_a_full_disk_is_told_with_the_file_and_loses_nothing(here, limit, file):
    (here / "small.toml").write_text(FAST)
    cases.compile_once(Settings("event-driven"))
    code, output = apart(limited, limit)
    assert code == 2, output
    assert f"Error: {file}: " in output
    assert not (here / "small.nc").exists()
    assert "24 ok" in invoke("run", "small.toml", "--n-jobs", 1)
    assert not list(here.glob(".small*"))


@pytest.mark.acceptance
def test_umlauts_where_the_locale_has_none(here):
    """The locale C knows ASCII only; files are UTF-8 all the same."""
    (here / "prüfstand.toml").write_text(CONFIG.replace('"small"', '"Prüfstand µ"'), encoding="utf-8")
    environment = small_sweep.environment(LC_ALL="C", PYTHONUTF8="0", PYTHONCOERCECLOCALE="0")
    for command, code in ((("status", "prüfstand.nc"), 2), (("check", "prüfstand.toml"), 0)):
        words = small_sweep.command(*command)
        ended = subprocess.run(words, env=environment, capture_output=True, check=False)
        told = ended.stdout + ended.stderr
        assert ended.returncode == code, told
        assert b"Traceback" not in told
        assert b"pr" in told


def test_absurd_toml_is_refused_in_a_line(here):
    for text, words in (
        (f"title = 0x{'f' * 5000}\n", "title: 0xfff"),
        (f"title = {'[' * 3000}{']' * 3000}\n", "not valid TOML: nested more than 20 deep"),
        (f"a{'.a' * 1000} = 1\n", "not valid TOML: nested more than 20 deep"),
    ):
        (here / "x.toml").write_text(text + CONFIG.replace('title = "small"', ""))
        for command in ("check", "run"):
            assert f"x.toml: {words}" in invoke(command, "x.toml", code=2)


def test_a_listed_case_is_as_much_work_among_many_as_among_few(here):
    def listed(number):
        """Text of a list of cases, and the number of Python calls to read them and to make their records."""
        text = "".join(
            f'[[sweep.case]]\nfriction_law = "coulomb"\nbeta = {0.1 + 1e-3 * i:.3f}\namplitude_mm = 1.0\n'
            for i in range(number)
        )
        calls, records = python_calls(lambda: config.parse(text).records())
        assert records.size == number
        return text, calls

    few, many = listed(200), listed(2000)
    assert many[1] < 11 * few[1]
    (here / "many.toml").write_text(many[0] + many[0][: many[0].index("[[", 2)])
    assert "sweep.case[2000]: repeats sweep.case[0]; keep one" in invoke("check", "many.toml", code=2)


def test_a_diagnosis_leaves_its_result_and_nothing_else_and_a_foreign_report_stays(here, monkeypatch):
    found = DiagnosisResult(*fixture_diagnosis.build(), "extended")
    monkeypatch.setattr(api, "diagnose_measurement", lambda *given, **more: found)
    before = set(here.iterdir())
    told = invoke("diagnose", "measured.toml", "--no-report", "-o", "results/first")
    assert "wrote results/first" in told
    assert set(here.iterdir()) - before == {here / "results"}
    assert [path.name for path in (here / "results").iterdir()] == ["first"]
    assert len(list((here / "results" / "first").iterdir())) == 3
    (here / "result").mkdir()
    (here / "result" / "report.html").write_text("mine")
    told = invoke("diagnose", "measured.toml", "-o", "result", code=2)
    assert "result/report.html: not the result of a diagnosis; choose another -o" in told
    assert (here / "result" / "report.html").read_text() == "mine"
    # An earlier result gives way to a complete one only.
    for name in ("diagnosis.json", "report.html", "gain.png", "mine.txt"):
        (here / "result" / name).write_text("old")
    (here / "made").mkdir()
    for name in ("diagnosis.json", "diagnosis.nc"):
        (here / "made" / name).write_text("new")
    _move(here / "made", here / "result")
    left = {path.name: path.read_text() for path in (here / "result").iterdir()}
    assert left == {"diagnosis.json": "new", "diagnosis.nc": "new", "mine.txt": "old"}
