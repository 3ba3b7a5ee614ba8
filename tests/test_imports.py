"""Imports run one way (table below), only the command line prints or exits, and no test asserts a time."""

import ast
import os
import re
from functools import cache, partial
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from tests import command, small_sweep
from wedgesweep import processes

ROOT = Path(__file__).parent.parent
PACKAGE, SCRIPTS = ROOT / "wedgesweep", ROOT / "scripts"
STUDIES = ("reproduce", "validation")


def files_of(root, folder="."):
    return {path.relative_to(root).as_posix(): path for path in sorted((root / folder).rglob("*.py"))}


FILES = files_of(PACKAGE)

NUMERICS = (
    *("compiled.py", "inner_code.py", "outcome.py", "natural_units.py", "quantity.py"),
    *("excitation.py", "sampled_input.py", "sensor.py", "trigonometry.py"),
    *("friction/", "effects/", "hybrid/", "systems/", "solvers/", "response.py", "simulate.py"),
)
ABOVE = (*("sweep", "config", "figures", "measured", "synthesize", "cli", "report"), "diagnosis_result")
MECHANICS = ("friction", "effects", "excitation", "sampled_input")
FORBIDDEN = {
    NUMERICS: ("xarray", "joblib", "netCDF4", *(f"wedgesweep.{name}" for name in ABOVE)),
    # A solver knows a system by hybrid/interface.py, and by the kits of its records.
    ("hybrid/",): tuple(f"wedgesweep.{name}" for name in (*MECHANICS, "systems", "solvers", "response")),
    ("solvers/",): tuple(f"wedgesweep.{name}" for name in (*MECHANICS, "systems.suspension")),
    ("friction/", "effects/"): ("wedgesweep.systems", "wedgesweep.solvers"),
    ("systems/",): ("wedgesweep.solvers", "wedgesweep.response"),
    ("config/", "inputs/", "readers/"): ("xarray", "joblib", "wedgesweep.sweep", "wedgesweep.measured"),
    ("inputs/", "readers/", "toml.py", "hints.py"): ("wedgesweep.config",),
    ("measured/",): (
        "xarray",
        *(f"wedgesweep.{name}" for name in ("simulate", "solvers", "sweep", "synthesize")),
    ),
    # Synthetic data come from another integrator than a fit uses.
    ("synthesize/",): (
        *("xarray", "wedgesweep.sweep.run", "wedgesweep.sweep.batch"),
        "wedgesweep.solvers.event_driven",
    ),
    ("sweep/",): tuple(f"wedgesweep.{name}" for name in ("figures", "report", "diagnose", "measured", "cli")),
    tuple(
        f"sweep/{name}.py" for name in ("variables", "dataset", "journal", "cases", "batch", "continuation")
    ): ("wedgesweep.sweep.run",),
    ("figures/",): tuple(f"wedgesweep.{name}" for name in ("sweep", "report", "diagnose", "cli")),
    ("report/", "diagnosis_result.py"): ("wedgesweep.sweep.run", "wedgesweep.diagnose", "wedgesweep.cli"),
    ("formatting.py",): ("wedgesweep", "numpy"),
    ("validation/",): ("wedgesweep.diagnose", "wedgesweep.solvers", "wedgesweep.cli"),
    ("validation/simulator.py",): ("wedgesweep",),
}
ONLY_IN = {
    "click": ("cli/",),
    "matplotlib": ("figures/", "api.py"),  # there for annotations only
    "joblib": (*("sweep/backend.py", "sweep/verification.py"), *("synthesize/", "cli/")),
    "distributed": ("sweep/cluster.py",),
    "wedgesweep.cli": ("cli/", "__main__.py"),
}


@cache
def tree(path):
    return ast.parse(path.read_text())


@cache
def imports(path):
    return list(imported(tree(path)))


def imported(tree):
    """Full names of all that a file imports, at its top or inside functions."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def imports_any(path, modules):
    return sorted({name for name in imports(path) for m in modules if f"{name}.".startswith(f"{m}.")})


@pytest.mark.parametrize("files", FORBIDDEN, ids=lambda files: files[0])
def test_nothing_imports_what_is_above_it(files):
    every = FILES | files_of(SCRIPTS, "validation")
    checked = [name for name in every if name.startswith(files)]
    assert checked
    assert {name: imports_any(every[name], FORBIDDEN[files]) for name in checked} == {
        name: [] for name in checked
    }


def test_the_package_imports_no_study():
    assert all(files_of(SCRIPTS, study) for study in STUDIES)
    assert {name: found for name, path in FILES.items() if (found := imports_any(path, STUDIES))} == {}


@pytest.mark.parametrize("module", ONLY_IN)
def test_imported_in_its_own_place_only(module):
    users = [name for name, path in FILES.items() if imports_any(path, [module])]
    assert users
    assert [name for name in users if not name.startswith(ONLY_IN[module])] == []


def without_type_hints(path):
    """The tree of a file without what it imports for type hints only."""
    body = [
        node
        for node in tree(path).body
        if not (isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test))
    ]
    return ast.Module(body, [])


def test_no_imports_run_in_a_circle():
    modules = {
        ".".join(("wedgesweep", *Path(name).with_suffix("").parts)).removesuffix(".__init__"): path
        for name, path in FILES.items()
    }
    graph = {}
    for module, path in modules.items():
        names = imported(without_type_hints(path))
        graph[module] = {
            name if name in modules else name.rpartition(".")[0] for name in names
        } & modules.keys()
    graph["wedgesweep"].clear()  # it loads the functions that it offers when they are used
    assert len(graph["wedgesweep.cli"]) > 5
    TopologicalSorter(graph).prepare()  # raises CycleError


def identifiers(path):
    """Words of all names in a file but those of NumPy, those of imports and of attributes included."""
    nodes = [
        node for node in ast.walk(ast.parse(path.read_text())) if not ast.unparse(node).startswith("np.")
    ]
    for node in nodes:
        named = (getattr(node, field, None) for field in ("id", "attr", "arg", "name", "asname", "module"))
        yield from (
            word for name in named if isinstance(name, str) for word in re.split(r"[._]", name.lower())
        )


def test_solvers_know_no_part_of_the_suspension():
    parts = {"wedge", "bolster", "column", "suspension"}
    files = [name for name in FILES if name.startswith(("hybrid/", "solvers/"))]
    named = {name: parts.intersection(identifiers(FILES[name])) for name in files}
    assert files
    assert {name: found for name, found in named.items() if found} == {}


def test_only_the_command_line_prints_or_exits():
    words = {"print", "exit", "quit", "_exit", "SystemExit"}
    for name, path in FILES.items():
        nodes = ast.walk(tree(path))
        used = {getattr(node, "id", getattr(node, "attr", "")) for node in nodes} & words
        entry = name.startswith(("cli/", "__main__.py"))
        assert entry or not used, f"{name}: {used}"


OPTIONAL = ("matplotlib", "xarray", "pandas", "netCDF4", "joblib", "scipy.integrate", "scipy.optimize")
# What an import, or a command, does not load; a config needs the effects, which are compiled functions.
UNLOADED = {
    "import wedgesweep": (*OPTIONAL, "scipy", "numba", "numpy"),
    "from wedgesweep.cli import cli; cli(['--help'], standalone_mode=False)": (
        *OPTIONAL,
        *("scipy", "numba", "numpy", "wedgesweep.config"),
    ),
    "import wedgesweep.sweep.cases": ("xarray", "pandas", "matplotlib"),  # what each job of a sweep loads
    "from wedgesweep.sweep import dataset, variables": (*OPTIONAL, "numba", "scipy", "wedgesweep.config"),
    "from wedgesweep.sweep import outcomes; from wedgesweep.figures import models": (
        *("matplotlib", "numba", "scipy", "wedgesweep.config"),
    ),
    "from wedgesweep.figures import FIGURES; assert FIGURES": (
        *OPTIONAL,
        "scipy",
        "numba",
        "numpy",
    ),
    "import wedgesweep.config": (*OPTIONAL, "wedgesweep.solvers.radau", "wedgesweep.solvers.event_driven"),
}


@pytest.mark.parametrize("code", UNLOADED)
def test_what_is_not_needed_is_not_loaded(code):
    script = f"import sys\n{code}\nprint('loaded:', *sys.modules.keys() & {UNLOADED[code]!r})"
    found = small_sweep.ended("-c", script)
    assert found.stdout.splitlines()[-1] == "loaded:"


TESTS = Path(__file__).parent
CLOCKS = {
    *("time", "monotonic", "perf_counter", "process_time", "thread_time"),
    *("time_ns", "monotonic_ns", "perf_counter_ns", "process_time_ns", "thread_time_ns"),
    *("clock_gettime", "clock_gettime_ns", "getrusage", "timeit", "default_timer", "now", "utcnow"),
}
MODULES = {"time", "resource", "timeit", "datetime"}


def clocks(source: str) -> list[str]:
    """Clocks that some Python code reads, imported by name or called through their modules."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and node.module in MODULES:
            found += [name.name for name in node.names if name.name in CLOCKS]
        if isinstance(node, ast.Attribute) and node.attr in CLOCKS:
            owner = getattr(node.value, "attr", None) or getattr(node.value, "id", "")
            found += [f"{owner}.{node.attr}"] if owner in MODULES else []
    return found


def test_only_the_limit_of_hanging_processes_reads_a_clock():
    found = {path: clocks(path.read_text()) for path in TESTS.rglob("*.py")}
    assert found.pop(Path(command.__file__)) == ["perf_counter"]
    assert {path.name: names for path, names in found.items() if names} == {}


def endless():
    while True:
        pass


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes cannot fork here")
@pytest.mark.parametrize("work", [endless, partial(os._exit, 1)], ids=["endless", "dies"])
def test_a_library_that_dies_or_finds_no_end_is_an_error(monkeypatch, work):
    monkeypatch.setattr(processes, "MOST_WORK", 1)
    with pytest.raises(OSError, match="gave up, or found no end"):
        processes.apart(work)


def test_what_is_found_apart_comes_back():
    assert processes.apart(divmod, 7, 2) == (3, 1)
    with pytest.raises(ZeroDivisionError):
        processes.apart(divmod, 7, 0)
