"""The command line: what it prints, which files it leaves, and its exit codes."""

import json
import os
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from tests import fixture_dataset, fixture_diagnosis, small_sweep
from tests.command import invoke
from tests.small_sweep import FAST, LOCKED
from wedgesweep import config, figures, files
from wedgesweep.cli import cli
from wedgesweep.cli.failure import _failure
from wedgesweep.figures import friction_laws, phase_portrait

FEW = FAST.replace("1.1, ", "")
PNG = b"\x89PNG"


@pytest.fixture
def here(tmp_path, monkeypatch):
    """Empty current directory with a small config."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "few.toml").write_text(FEW)
    (tmp_path / "locked.toml").write_text(LOCKED)
    return tmp_path


@pytest.fixture(scope="module")
def drawn_dataset(tmp_path_factory):
    path = tmp_path_factory.mktemp("drawn") / "fixture.nc"
    fixture_dataset.build().to_netcdf(path)
    return path


def run(*arguments, code=0):
    return invoke("run", *arguments, "--n-jobs", 1, code=code)


def test_help_and_version():
    for arguments in ([], ["-h"], ["--help"]):
        assert "_WEDGESWEEP_COMPLETE=bash_source" in invoke(*arguments, code=0 if arguments else 2)
    assert "0." in invoke("--version")
    for name in cli.commands:
        told = invoke(name, "-h")
        assert all(option in told for option in ("--help", "--quiet", "--verbose"))
    told = invoke("plot", "-h")
    for kind in figures.FIGURES.values():
        assert f"{kind.name} " in told
        assert kind.description in told


def test_every_process_gets_one_thread_and_answers_a_shell_that_completes_words():
    code = (
        "import os, sys; sys.argv = ['wedgesweep']\n"
        "from wedgesweep.__main__ import THREADS, main\n"
        "assert 'numpy' not in sys.modules\n"
        "try: main()\n"
        "finally: assert [os.environ[name] for name in THREADS] == ['1', '1', '1']"
    )
    asked = {"OPENBLAS_NUM_THREADS": "7", "_WEDGESWEEP_COMPLETE": "bash_source"}
    assert "complete -o" in small_sweep.ended("-c", code, **asked).stdout


def test_init_writes_a_config_that_is_valid(here):
    assert "wrote wedgesweep.toml" in invoke("init")
    written = (here / "wedgesweep.toml").read_text()
    assert config.parse(written).case_list()
    assert invoke("init", "-") == written
    assert "exists; --force overwrites it" in invoke("init", code=2)
    (here / "mine.toml").write_text("mine")
    invoke("init", "mine.toml", code=2)
    assert (here / "mine.toml").read_text() == "mine"
    invoke("init", "mine.toml", "--force")
    assert (here / "mine.toml").read_text() == written
    assert "'absent' is not a directory" in invoke("init", "absent/x.toml", code=2)


def test_schema(here):
    printed = invoke("schema")
    invoke("schema", "-o", "schema.json")
    assert (here / "schema.json").read_text() == printed
    assert "$defs" in json.loads(printed)


def test_check_tells_cases_time_and_size(here):
    told = invoke("check", "few.toml")
    assert "16 = 2 friction laws x 2 frequencies x 4 amplitudes" in told
    assert re.search(r"\(from \d+ cases run now\)", told)
    for quantity in ("title: small", "time: about", "memory: about", "dataset: at most"):
        assert quantity in told
    assert sorted(path.name for path in here.iterdir()) == ["few.toml", "locked.toml"]
    told = invoke("check", "locked.toml")
    # On a slow machine one of the two cases is tried.
    assert re.search(r"of those, [12] cases? failed, the first by: normal forces not unique", told)


def test_one_case_is_counted_in_the_singular(here):
    grid = '[sweep]\nfriction_law = "coulomb"\nbeta = 1.4\namplitude_mm = 0.5\n'
    solver = '[solver]\nmethod = "event-driven"\nsettle = "steady"\n'
    (here / "one.toml").write_text(grid + solver)
    assert "cases: 1 = 1 friction law x 1 frequency x 1 amplitude\n" in invoke("check", "one.toml")
    answer = run("one.toml")
    assert answer.startswith("1 case\n1/1 case, ")
    assert "1 case: 1 ok" in answer
    assert "wrote one.csv: 1 case\n" in invoke("export", "one.nc")


def test_a_wrong_config_is_reported_whole_and_nothing_is_run(here):
    (here / "wrong.toml").write_text('[sweep]\nbetta = 1.0\namplitude_mm = -1.0\nfriction_law = "x"\n')
    for command, *more in (("check",), ("run",), ("case", "--beta", 1, "--amplitude", 1)):
        told = invoke(command, "wrong.toml", *more, code=2)
        for words in ("wrong.toml: sweep.betta", "sweep.amplitude_mm", "sweep.friction_law"):
            assert words in told
        assert "absent.toml: No such file" in invoke(command, "absent.toml", *more, code=2)
    (here / "steady.toml").write_text(FEW.replace("settle_periods = 3", 'settle = "steady"'))
    assert 'steady.toml: solver "radau": solver.settle' in run("steady.toml", "--solver", "radau", code=2)
    assert not list(here.glob("*.nc*"))
    # What is odd and may be meant is told.
    assert "friction.static" not in invoke("check", "few.toml")
    (here / "few.toml").write_text(FEW + "\n[friction]\nstatic = 0.1\ndynamic = 0.3\n")
    told = invoke("check", "few.toml")
    assert "friction.static = 0.1 is below friction.dynamic = 0.3: friction rises once" in told


@pytest.mark.parametrize(
    ("solver", "changing"),
    [("duration_s = 0.1", 2), ('settle = "steady"', 0), ('settle = "steady"\nmax_periods = 10', 2)],
)
def test_cases_that_had_not_settled_are_counted(here, solver, changing):
    sweep = '[sweep]\nfriction_law = "static-dynamic"\nbeta = [1.1, 2.0]\namplitude_mm = 1.0\n'
    (here / "brief.toml").write_text(f'{sweep}[solver]\nmethod = "event-driven"\n{solver}\n')
    for told in (run("brief.toml"), invoke("status", "brief.nc")):
        assert "2 cases: 2 ok" in told
        assert ("2 of 2 cases (100 %) did not reach steady state" in told) == (changing == 2)
        assert ("did not reach steady state" in told) == (changing > 0)


def test_run_then_run_again_then_another_config(here):
    told = run("few.toml")
    assert "16 cases: 16 ok" in told
    assert "16/16 cases" in told
    assert "dataset: few.nc" in told
    with xr.open_dataset("few.nc") as ds:
        assert ds.attrs["history"].split(": ", 1)[1].startswith("wedgesweep")
    before = (here / "few.nc").read_bytes()
    assert "few.nc: already complete" in run("few.toml")
    told = invoke("status", "few.nc")
    assert "few.nc: complete\ntitle: small" in told
    assert f"numpy {np.__version__}" in told
    assert "16 cases: 16 ok" in told

    (here / "few.toml").write_text(FEW.replace("2.5]", "2.6]"))
    told = run("few.toml", code=2)
    assert "few.nc: holds another sweep (sweep.beta: [0.3, 2.5] there, [0.3, 2.6] now)" in told
    assert "--fresh to discard it" in told
    assert (here / "few.nc").read_bytes() == before
    assert "16 ok" in run("few.toml", "--fresh")
    with xr.open_dataset("few.nc") as ds:
        assert ds["beta"].values.tolist() == [0.3, 2.6]
    assert sorted(path.name for path in here.iterdir()) == ["few.nc", "few.toml", "locked.toml"]


def test_failed_cases_are_counted_and_listed(here):
    told = run("locked.toml", code=1)
    assert "2 cases: 2 locked" in told
    assert "coulomb, beta 1.1, amplitude 2 mm: locked: normal forces not unique" in told
    assert "dataset: locked.nc" in told
    assert "already complete" in run("locked.toml", code=1)
    assert "2 locked" in invoke("status", "locked.nc", code=1)


def test_fail_fast_keeps_what_is_finished(here, monkeypatch):
    told = run("locked.toml", "--fail-fast", code=1)
    assert "stopped at coulomb, beta 1.1, amplitude 2 mm: normal forces not unique" in told
    assert "1 finished case is stored in locked.nc.partial" in told
    run("locked.toml", "--fail-fast", code=1)  # going on does not make it forget the failure
    assert not (here / "locked.nc").exists()
    told = invoke("status", "locked.nc", code=1)
    assert "locked.nc.partial: unfinished\ntitle: small" in told
    assert "2 cases: 1 locked, 1 remaining" in told
    # Neither another version nor another config goes on with it.
    with monkeypatch.context() as patched:
        patched.setattr("wedgesweep.sweep.fingerprint.__version__", "99.0")
        told = invoke("status", "locked.nc", code=1)
    assert "cannot be resumed: wedgesweep: " in told
    assert "there, 99.0 now" in told
    (here / "other.toml").write_text(LOCKED.replace("2.0", "1.5"))
    told = run("other.toml", "-o", "locked.nc", code=2)
    assert "locked.nc.partial: an unfinished sweep with another config or version" in told
    assert "sweep.amplitude_mm: [2.0] there, [1.5] now" in told
    assert "--fresh to discard it" in told
    told = run("locked.toml", "--keep-going", code=1)
    assert "2 cases, 1 of them from an earlier run" in told
    assert (here / "locked.nc").exists()


def test_case_timeout(here):
    told = run("few.toml", "--case-timeout", 1e-6, "--solver", "radau", code=1)
    assert "time_limit: gave up after 1e-06 s" in told
    assert "and " in told  # no more than some are listed
    assert told.count("gave up") == 5
    assert "Invalid value" in run("few.toml", "--case-timeout", 0, code=2)


def test_outputs_that_cannot_be_are_refused_before_any_case(here):
    (here / "mine.nc").write_text("mine")
    xr.Dataset({"mine": 1}).to_netcdf("measured.nc")
    (here / "folder").mkdir()
    root = os.geteuid() == 0
    for output, words in {
        "absent/x.nc": "'absent' is not a directory",
        "few.toml/x.nc": "'few.toml' is not a directory",
        "folder": "is a directory",
        "mine.nc": "mine.nc: not a netCDF dataset",
        "measured.nc": "measured.nc: not the dataset of a sweep",
        "few.toml": "few.toml: netCDF is written, and .toml is the ending of TOML; end it in .nc",
        "study.png": "study.png: netCDF is written, and .png is the ending of a figure; end it in .nc",
        "/proc/x.nc": "/proc/x.nc.partial: No such file" if root else "'/proc' is not writable",
    }.items():
        for fresh in ((), ("--fresh",)):
            told = run("few.toml", "-o", output, *fresh, code=2)
            assert words in told
            assert "16 cases" not in told
    assert (here / "mine.nc").read_text() == "mine"
    assert (here / "few.toml").read_text() == FEW


def test_what_is_written_does_not_get_the_ending_of_another_format(here):
    (here / "few.nc").write_text("mine")
    for command, words in (
        (("export", "few.nc", "-o", "few.nc"), "few.nc: CSV is written, and .nc is the ending of netCDF"),
        (("init", "study.nc"), "study.nc: TOML is written, and .nc is the ending of netCDF; end it in .toml"),
        (("schema", "-o", "s.html"), "s.html: JSON is written, and .html is the ending of a page"),
    ):
        assert words in invoke(*command, code=2)
    assert (here / "few.nc").read_text() == "mine"
    assert not any((here / name).exists() for name in ("study.nc", "s.html"))
    for name in ("study", "study.v2", "study.NC", "study.h5", "study.partial"):
        assert files.mismatch(Path(name), files.NETCDF) is None


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_directory_without_write_permission(here):
    (here / "folder").mkdir(mode=0o555)
    assert "is not writable" in run("few.toml", "-o", "folder/x.nc", code=2)


def test_status_of_nothing(here):
    assert "absent.nc: no such file" in invoke("status", "absent.nc", code=2)
    assert "few.toml: a config, where the dataset of a run is wanted" in invoke("status", "few.toml", code=2)
    (here / "x.nc.partial").write_text("text\n")
    assert "not the journal of a sweep" in invoke("status", "x.nc", code=2)


def numbers(told):
    """Number and unit by name, from what ``case`` prints."""
    lines = [line.split() for line in told.splitlines() if line.startswith("  ")]
    split = [next(i for i, word in enumerate(line) if word[-1].isdigit()) for line in lines]
    return {" ".join(line[:i]): line[i : i + 2] for line, i in zip(lines, split, strict=True)}


def test_case_prints_stores_and_draws(here):
    told = invoke("case", "few.toml", "--law", "exponential", "--beta", 0.77, "--amplitude", 0.9)
    assert "exponential, beta 0.77, amplitude 0.9 mm, 10.46" in told
    ds = xr.load_dataset("few-exponential-0.77-0.9mm.nc")
    assert (here / "few-exponential-0.77-0.9mm.png").read_bytes().startswith(PNG)
    assert ds["amplitude"].item() == 0.0009
    assert ds.sizes["phase"] == 64
    found = numbers(told)
    assert found["peak to peak"] == [f"{ds['peak_to_peak'].item() * 1e3:.6g}", "mm"]
    assert found["phase lag"] == [f"{np.degrees(ds['phase_lag'].item()):.6g}", "deg"]
    assert found["dissipated energy"] == [f"{ds['dissipated_energy'].item() * 1e3:.6g}", "mJ"]


@pytest.mark.usefixtures("empty_pictures")
def test_case_agrees_with_the_sweep_sticks_and_fails(here):
    run("few.toml")
    sweep = xr.load_dataset("few.nc").sel(friction_law="coulomb", beta=2.5, amplitude=0.0012)
    hertz = repr(sweep["frequency"].item())
    invoke("case", "few.toml", "--frequency", hertz, "--amplitude", 1.2, "-o", "one")
    one = xr.load_dataset("one.nc").squeeze()
    assert one["friction_law"] == "coulomb"
    assert one["amplitude_ratio"].item() == pytest.approx(sweep["amplitude_ratio"].item(), rel=1e-6)
    assert (here / "one.png").exists()
    xr.Dataset({"mine": 1.0}).to_netcdf("mine.nc")
    for name, words in (("few", "few.nc: holds a sweep"), ("mine", "mine.nc: holds a sweep or other data")):
        told = invoke("case", "few.toml", "--beta", 1, "--amplitude", 1, "-o", name, code=2)
        assert words in told
    told = invoke("case", "few.toml", "--law", "coulomb", "--beta", 0.02, "--amplitude", 0.01, "--quiet")
    for words in (r"phase lag +– deg", r"minimum normal force +– N", r"mean displacement +0 mm"):
        assert re.search(words, told)
    before = set(here.iterdir())
    told = invoke("case", "locked.toml", "--beta", 1.1, "--amplitude", 2, code=1)
    assert "failed: normal forces not unique" in told
    assert set(here.iterdir()) == before


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--amplitude", 1], "either --beta or --frequency"),
        (["--amplitude", 1, "--beta", 1, "--frequency", 20], "either --beta or --frequency"),
        (["--beta", 1], "either --amplitude or --force"),
        (["--beta", 1, "--force", 2.0], "Error: few.toml: its input is a motion: give --amplitude\n"),
        (["--amplitude", "nan", "--beta", 1], "sweep.amplitude_mm"),
        (["--amplitude", 1, "--beta", 0], "sweep.beta"),
        (["--amplitude", 1, "--frequency", -2], "sweep.frequency_hz"),
        (["--amplitude", 1, "--beta", 1, "--law", "coulom"], 'did you mean "coulomb"?'),
        (["--amplitude", 1, "--beta", 1, "-o", "absent/x"], "is not a directory"),
    ],
)
def test_case_faults(here, arguments, words):
    assert words in invoke("case", "few.toml", *arguments, code=2)


@pytest.mark.usefixtures("empty_pictures")
def test_plot_one_kind(here, drawn_dataset):
    told = invoke("plot", "friction-laws", drawn_dataset, "-o", "r.svg")
    assert told == "wrote r.svg\n"
    assert (here / "r.svg").exists()
    beside = drawn_dataset.with_name("friction-laws.png")
    for file, options in ((beside, ()), (beside.with_suffix(".pdf"), ("--format", "pdf"))):
        assert f"wrote {file}" in invoke("plot", "friction-laws", drawn_dataset, *options)
        assert file.exists()


def test_plot_options_reach_the_figure_in_si(here, drawn_dataset, monkeypatch):
    given = {}

    def draw(target, ds, beta=None, amplitudes=None):
        given.update(beta=beta, amplitudes=amplitudes, law=ds["friction_law"].item())
        return friction_laws.draw(target, ds)

    monkeypatch.setattr(phase_portrait, "draw", draw)
    options = ("--beta", 0.4, "--amplitude", 0.2, "--amplitude", 1, "--law", "coulomb", "-o", "x.png")
    invoke("plot", "phase-portrait", drawn_dataset, *options)
    assert given == {"beta": 0.4, "amplitudes": pytest.approx([2e-4, 1e-3]), "law": "coulomb"}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["stick-map", "OUT", "--beta", 1], "stick-map: takes no --beta"),
        (["bifurcation", "OUT", "--amplitude", 1, "--amplitude", 4], "takes a single --amplitude"),
        (["phase-portrait", "OUT", "--law", "viscous"], "no friction law 'viscous'"),
        (["stick-map", "OUT", "-o", "x.jpeg"], ".png, .pdf, .svg"),
        (["stick-map", "OUT", "-o", "absent/x.png"], "absent: not a directory"),
        (["stick-map", "absent.nc"], "absent.nc: no such file"),
        (["stick-map", "few.toml"], "few.toml: a config, where the dataset of a run"),
        (["stickmap", "OUT"], "is not one of"),
        (["all", "OUT", "-o", "few.toml"], "few.toml: not a directory"),
        (["all", "absent/x.nc"], "absent/x.nc: no such file"),
        (
            ["stick-map", "OUT", "--format", "pdf", "-o", "x.png"],
            "--format pdf and -o x.png contradict each other",
        ),
    ],
)
def test_plot_faults(here, drawn_dataset, arguments, words):
    replaced = [drawn_dataset if argument == "OUT" else argument for argument in arguments]
    assert words in invoke("plot", *replaced, code=2)
    assert sorted(path.name for path in here.iterdir()) == ["few.toml", "locked.toml"]


def test_errors_of_the_system_are_told_without_a_traceback():
    with pytest.raises(MemoryError) as caught:
        np.empty(2**55)
    assert str(_failure(caught.value)).startswith("not enough memory: Unable to allocate")
    assert str(_failure(MemoryError())) == "not enough memory"
    assert str(_failure(TimeoutError("no answer"))) == "no answer"
    assert str(_failure(TimeoutError())) == "TimeoutError"


@pytest.mark.usefixtures("empty_pictures")
def test_picks_off_the_grid_are_told_and_those_far_off_are_errors(here, drawn_dataset):
    to = ("-o", "figure.png")
    assert invoke("plot", "response", drawn_dataset, *to, "--beta", 0.4) == "wrote figure.png\n"
    told = invoke("plot", "response", drawn_dataset, *to, "--frequency", 5.3, "--law", "COULOMB")
    assert "--frequency 5.3: the nearest one there is 5.434 Hz" in told
    told = invoke("plot", "bifurcation", drawn_dataset, *to, "--amplitude", 1.05)
    assert "--amplitude 1.05: the nearest one there is 1 mm" in told
    for arguments, words in (
        (("response", "--beta", 99), "--beta 99: no case is near; the dataset has 20 from 0.1 to 3.8"),
        (
            ("bifurcation", "--amplitude", 50),
            "--amplitude 50: no case is near; the dataset has 0.01, 0.05, 0.2, 0.5, 1, 4 mm",
        ),
        (("response", "--beta", 1, "--frequency", 10), "give either --beta or --frequency"),
        (("stick-map", "--law", "x"), "stick-map: no friction law 'x' in the dataset; it has coulomb, stat"),
    ):
        assert words in invoke("plot", arguments[0], drawn_dataset, *to, *arguments[1:], code=2)


def test_what_lies_outside_of_validity_is_counted_and_told(here, drawn_dataset):
    told = invoke("status", drawn_dataset, code=1)
    assert (
        "lie outside of the model's validity: a joint pulls where a real one would lift off (variable "
        in told
    )
    assert "did not reach steady state" in told
    told = invoke("case", "few.toml", "--law", "Coulomb", "--beta", 1.1, "--amplitude", 1e9)
    assert "outside of the model's validity: a joint pulls in" in told


@pytest.mark.usefixtures("empty_pictures")
def test_plot_of_a_diagnosis(here, drawn_dataset):
    fixture_diagnosis.write(here / "found", "tied", tests=2)
    assert invoke("plot", "candidates", "found") == "wrote found/candidates.png\n"
    assert invoke("plot", "misfit", "found", "--format", "svg", "-o", "m.svg") == "wrote m.svg\n"
    assert "skipped gain: no test was held out" in invoke("plot", "all", "found", "-o", "figures")
    assert (here / "figures" / "waveforms.png").exists()
    for arguments, words in (
        (["misfit", drawn_dataset], "no figure 'misfit' of these data; there are amplitude-ratio, "),
        (["stick-map", "found"], "no figure 'stick-map' of these data; there are candidates, "),
        (["gain", "found"], "gain: no test was held out"),
        (["misfit", "found", "--beta", 1], "misfit: takes no --beta"),
        (["misfit", "figures"], "figures/diagnosis.json: no such file"),
    ):
        assert words in invoke("plot", *arguments, code=2)


@pytest.mark.usefixtures("empty_pictures")
def test_plot_all_says_what_does_not_suit(here):
    fixture_dataset.as_cases(fixture_dataset.build()).to_netcdf("cases.nc")
    told = invoke("plot", "all", "cases.nc")
    assert "skipped stick-map: needs a grid" in told
    assert (here / "phase-portrait.png").exists()
    xr.Dataset({"mine": 1}).to_netcdf("measured.nc")
    assert "not the dataset of a sweep" in invoke("plot", "all", "measured.nc", code=2)


@pytest.mark.usefixtures("empty_pictures")
def test_a_sweep_without_waveforms(here):
    (here / "few.toml").write_text(f"{FEW}keep_waveforms = false\n")
    assert "(from 16 cases run now)" in invoke("check", "few.toml")
    assert "16 ok" in run("few.toml")
    assert "16 cases: 16 ok" in invoke("status", "few.nc")
    told = invoke("plot", "all", "few.nc", "-o", "figures")
    for words in ("wrote figures/stick-map", "skipped phase-portrait", "skipped response"):
        assert words in told
    assert "run the sweep again with keep_waveforms = true" in invoke(
        "plot", "phase-portrait", "few.nc", code=2
    )
    # One case is run for its trajectory.
    invoke("case", "few.toml", "--beta", 0.77, "--amplitude", 0.9, "-o", "one")
    assert (here / "one.png").exists()
    assert xr.load_dataset("one.nc").sizes["phase"] == 64


ROOT = Path(__file__).parents[1]
MEASURED, CONFIG = ROOT / "examples/bench/measured.toml", ROOT / "configs/quick.toml"


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    directory = tmp_path_factory.mktemp("kinds")
    fixture_dataset.build().to_netcdf(directory / "sweep.nc")
    (directory / "sweep.data").write_bytes((directory / "sweep.nc").read_bytes())
    fixture_diagnosis.write(directory / "found", "tied", tests=2)
    return directory


@pytest.mark.parametrize("command", ["run", "check", "case"])
@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("sweep.nc", "the dataset of a run, where a config (TOML) is wanted; 'wedgesweep status'"),
        ("sweep.data", "the dataset of a run, where a config (TOML) is wanted"),
        ("found", "the result of a diagnosis, where a config (TOML) is wanted"),
        (MEASURED, "measured data, where a config (TOML) is wanted; 'wedgesweep check' and"),
    ],
)
def test_in_place_of_a_config(place, command, given, words):
    if command == "check" and given == MEASURED:
        return  # check reads both
    more = ("--beta", 1, "--amplitude", 1) if command == "case" else ()
    if command == "check":
        words = words.replace("(TOML) is", "(TOML) or a measurement is")
    assert f"{place / given}: {words}" in invoke(command, place / given, *more, code=2)


def test_in_place_of_measured_data(place):
    words = "where a measurement is wanted"
    assert f"sweep.nc: the dataset of a run, {words}" in invoke("diagnose", place / "sweep.nc", code=2)
    assert f"quick.toml: a config, {words}; 'wedgesweep run' runs it" in invoke("diagnose", CONFIG, code=2)


@pytest.mark.parametrize("command", [("status",), ("plot", "response"), ("export",)])
def test_in_place_of_a_dataset(command):
    for given, words in ((CONFIG, "a config"), (MEASURED, "measured data")):
        told = f"{words}, where the dataset of a run is wanted"
        if command[0] == "plot" and given == MEASURED:
            told = "no figure 'response' of these data; there are backbone"
        assert told in invoke(*command, given, code=2)
