"""The command line, called as a user would, and what tests of it and of processes share."""

from collections.abc import Callable
from functools import cache
from sys import setprofile
from time import perf_counter
from typing import Any

from click.testing import CliRunner

from wedgesweep.cli import cli


def invoke(*arguments: object, code: int = 0) -> str:
    """Output (stdout and stderr) of a command, which must end with this exit code."""
    result = CliRunner().invoke(cli, [str(argument) for argument in arguments])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == code, result.output
    return result.output


@cache
def hang_limit() -> float:
    """Time (s) after which a process is taken to hang: five minutes, or more on a slow or busy machine.

    The only clock in the tests (see test_imports.py): no test asserts a time.
    """
    began = perf_counter()
    sum(range(1_000_000))
    # An idle machine of 2020 takes 20 ms.
    return 300.0 * max(1.0, (perf_counter() - began) / 0.02)


def python_calls(function: Callable[[], Any]) -> tuple[int, Any]:
    """Number of Python functions that a function calls, itself among them, and what it returns."""
    calls = 0

    def count(frame: Any, event: str, argument: Any) -> None:
        nonlocal calls
        calls += event == "call"

    setprofile(count)
    try:
        result = function()
    finally:
        setprofile(None)
    return calls, result
