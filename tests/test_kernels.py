"""Where compiled code is kept, what it depends on, and what an import leaves as it was."""

import json
import os
from pathlib import Path

import pytest

from tests import small_sweep
from wedgesweep import friction, kernels, systems
from wedgesweep.systems.suspension import parameters

ROOT = Path(__file__).parents[1]
# A law as docs/extending.md describes them, with a number from a module beside it.
LAW = """
from math import nan
from wedgesweep.compiled import inlined
from numbers_of_mine import SCALE

EQUATIONS = ()
SET_VALUED = False

@inlined
def static(p):
    return p.friction.mu_s

@inlined
def sliding(speed, p):
    return SCALE * p.friction.mu_d

@inlined
def exponent(p):
    return 0.0

def bound(p):
    return 10.0
"""
# Coefficients of static-dynamic friction and of the registered law, by compiled code that is kept.
COEFFICIENTS = """
import json, sys
import numpy as np
from wedgesweep import friction, kernels
from wedgesweep.friction.curve import curve
from wedgesweep.systems import compact
from wedgesweep.systems.oscillator import parameters

body = {"mass": 1.0, "spring": 1e3, "normal_force": 1.0}
names = ["static-dynamic", *sys.argv[1:]]
if sys.argv[1:]:
    import my_law
    friction.register("my-law", my_law)
cases = [compact(parameters.record(name, 1e-3, 100.0, body)) for name in names]
found = [curve(np.array([0.1]), 1, case[0])[0] for case in cases]
print(json.dumps([kernels.folder().name, *found]))
"""
# What a process has that is not this package's.
PROCESS = """
import gc, json, os, signal, sys, warnings
import joblib, matplotlib, numba, numpy, xarray  # joblib sets a variable of its own
from numba.core.registry import cpu_target

def state():
    return {
        "environment": dict(os.environ),
        "collector": [gc.isenabled(), gc.get_threshold(), gc.get_freeze_count(), len(gc.callbacks)],
        "numba": {name: repr(value) for name, value in vars(numba.config).items() if name.isupper()},
        "typing": repr(vars(cpu_target.typing_context).get("resolve_function_type")),
        "signals": [repr(signal.getsignal(each)) for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)],
        "hooks": [repr(sys.excepthook), repr(warnings.showwarning)],
        "errors": repr(numpy.geterr()),
        "options": repr(sorted(xarray.get_options().items())),
        "folder": sorted(os.listdir()),
    }

def compile_and_run():
    import wedgesweep as ws
    from wedgesweep.systems.suspension import parameters

    ws.load_config("small.toml")
    parameters.record("coulomb", 1e-3, 100.0)  # compiles

before = state()
import wedgesweep
from wedgesweep import api, diagnose, figures, report, sweep, synthesize
after_import = state()
compile_and_run()
gc.collect()
print(json.dumps([before, after_import, state()]))
"""


def python(code, *arguments, **variables):
    """Standard output of a process of its own."""
    return small_sweep.ended("-c", code, *arguments, **variables).stdout


@pytest.fixture
def place(tmp_path, monkeypatch):
    """An empty cache folder."""
    monkeypatch.setenv(kernels.VARIABLE, str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_the_process_of_who_imports_it_stays_as_it_is(tmp_path):
    """Neither an import nor a compilation changes the collector, the environment or numba for others."""
    text = '[sweep]\nfriction_law = "coulomb"\nbeta = 1.0\namplitude_mm = 1.0\n'
    (tmp_path / "small.toml").write_text(text)
    before, imported, used = json.loads(python(f"import os; os.chdir({str(tmp_path)!r})\n" + PROCESS))
    assert imported == before
    assert used == before


def test_a_registered_law_and_what_it_imports_belong_to_the_key(tmp_path, place):
    """Code without the law is never used for it, nor code of an earlier version; each is kept and loaded."""
    paths = {"PYTHONPATH": os.pathsep.join([str(ROOT), str(tmp_path)])}
    (tmp_path / "my_law.py").write_text(LAW)

    def coefficients(*laws, scale=2.0):
        (tmp_path / "numbers_of_mine.py").write_text(f"SCALE = {scale}\n")
        folder, *found = json.loads(python(COEFFICIENTS, *laws, **paths))
        return folder, found

    without, (own,) = coefficients()
    folder, found = coefficients("my-law")
    assert found == pytest.approx([own, 2.0 * own], rel=1e-12)
    changed, found = coefficients("my-law", scale=3.0)
    assert found == pytest.approx([own, 3.0 * own], rel=1e-12)
    assert len({without, folder, changed}) == 3
    kept = {path: path.stat().st_mtime_ns for path in place.rglob("*.nbc")}
    assert coefficients() == (without, [own])
    assert {path: path.stat().st_mtime_ns for path in place.rglob("*.nbc")} == kept
    assert {path.relative_to(place).parts[0] for path in kept} == {without, folder, changed}


def test_the_key_is_of_the_sources_at_import(monkeypatch):
    """Code of a process would otherwise be kept under sources that were edited while it ran."""
    key = kernels.folder().name
    monkeypatch.setattr(Path, "read_bytes", lambda path: b"from wedgesweep.compiled import edited")
    assert kernels.folder().name == key


def test_an_unknown_law_is_an_error_and_so_is_one_that_comes_too_late(monkeypatch):
    case = parameters.record("coulomb", 1e-3, 100.0)
    systems.compact(case)
    case["friction"]["law"] = len(friction.LAWS)
    with pytest.raises(ValueError, match=r"friction law number 5 is not registered.*'coulomb'"):
        systems.compact(case)
    with pytest.raises(RuntimeError, match=r"'late': register laws before the first case"):
        friction.register("late", friction.LAWS["coulomb"])
    friction.register("coulomb", friction.LAWS["coulomb"])


def test_a_cache_that_cannot_be_written_is_told_and_another_one_used(tmp_path):
    """A file stands where the folder should be: also root cannot make it."""
    (tmp_path / "file").write_text("")
    wanted = tmp_path / "file" / "cache"
    code = (
        "import logging; logging.basicConfig(level='INFO');"
        "from wedgesweep import kernels; from wedgesweep.cli.compiling import announce_compiling;"
        "announce_compiling(); announce_compiling(); print(kernels.folder())"
    )
    variables = {kernels.VARIABLE: str(wanted), "TMPDIR": str(tmp_path)}
    places = [small_sweep.ended("-c", code, **variables) for _ in range(2)]
    assert places[0].stderr.count(f"{wanted} cannot be written to: compiled code is kept in {tmp_path}") == 1
    folder = Path(places[0].stdout.strip())
    assert folder.is_dir()
    assert folder.parent.stat().st_mode & 0o077 == 0
    assert places[1].stdout == places[0].stdout


def test_a_temporary_folder_of_somebody_else_is_not_used(tmp_path, monkeypatch):
    """Code from there would be run."""
    monkeypatch.setattr(kernels, "gettempdir", lambda: str(tmp_path))
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    (tmp_path / "wedgesweep-12345").mkdir()
    (tmp_path / "file").write_text("")
    monkeypatch.setenv(kernels.VARIABLE, str(tmp_path / "file" / "cache"))
    assert kernels.folder() is None


def test_code_that_nobody_used_for_a_month_is_removed(place):
    """And nothing else that lies there; code that is used stays however old it is."""
    unused, recent, others = (place / name for name in ("0" * 16, "1" * 16, "of the user"))
    for folder in (unused, recent, others):
        folder.mkdir(parents=True)
        (folder / "code").touch()
    used = place / kernels.folder().name
    for folder in (unused, others, used):
        os.utime(folder, (0.0, 0.0))
    kernels._usable.cache_clear()
    assert kernels.folder() == used
    assert {each.name for each in place.iterdir()} == {recent.name, others.name, used.name}


@pytest.mark.acceptance
def test_numbas_own_compiler_gives_the_same_numbers(place):
    """The way out where numba's internals differ from what inner_code.py needs."""
    found = [
        json.loads(python(COEFFICIENTS, **{kernels.VARIABLE: str(place), "WEDGESWEEP_COMPILER": compiler}))
        for compiler in ("", "plain")
    ]
    assert found[0][0] != found[1][0]
    assert found[0][1:] == found[1][1:]
