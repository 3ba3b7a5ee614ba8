"""No test asserts a time: a machine may be slow, or busy with something else."""

import ast
from pathlib import Path

from tests import command

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
