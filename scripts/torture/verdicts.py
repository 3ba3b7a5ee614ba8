"""What becomes of a command on hostile input, and what of that is a fault."""

import os
import re
import signal
import traceback
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import Any

from click.testing import CliRunner

ACCEPTED, REFUSED, FAILED = "accepted", "refused", "failed case"
TRACEBACK, HANG, WARNING, NOT_FINITE, NAMELESS, CODE = FAULTS = (
    *("traceback", "hang", "warning", "not finite", "names nothing", "exit code"),
)
# Processor time (s) that an input may take.
LIMIT = 20.0
NUMBERLESS = re.compile(r"(?<![\w.'\"])[-+]?(?:nan|inf|infinity)(?![\w'\"])", re.IGNORECASE)
# What an input calls itself: lines on its origin, the first word of a row of a table, and quoted texts.
NAMES = re.compile(
    r"\"[^\"\n]*\"|^(?:(?:title|started|model|versions|cannot be resumed): .*$|\S+)", re.MULTILINE
)
# What a message names: a file of the directory, or an option or argument of the command.
OPTION = re.compile(r"--?\w|'?[A-Z_]{3,}'?|Usage:|argument")


@dataclass(frozen=True)
class Verdict:
    """How a command ended, and what it said."""

    outcome: str
    output: str

    @property
    def fault(self) -> bool:
        return self.outcome in FAULTS


class Hanging(BaseException):
    """A command that takes too long."""


def judge(command: Sequence[str], limit: float = LIMIT) -> Verdict:
    """Run a command in this process, in the current directory."""
    from wedgesweep.cli import cli

    try:
        with warnings.catch_warnings(record=True) as warned, _limited(limit):
            warnings.simplefilter("always")
            result = CliRunner().invoke(cli, list(command))
    except Hanging as error:
        return Verdict(HANG, _trace(error))
    found = result.exception
    if found is not None and not isinstance(found, SystemExit):
        return Verdict(TRACEBACK, _trace(found))
    if warned:
        return Verdict(
            WARNING, f"{warned[0].filename}:{warned[0].lineno}: {warned[0].message}\n{result.output}"
        )
    return Verdict(_outcome(result, command), result.output)


def _outcome(result: Any, command: Sequence[str]) -> str:
    if result.exit_code == 2:
        return REFUSED if _names_something(result.stderr, command) else NAMELESS
    if result.exit_code not in (0, 1):
        return CODE
    if set(NUMBERLESS.findall(NAMES.sub("", result.stdout))) - set(command):
        return NOT_FINITE
    return FAILED if result.exit_code else ACCEPTED


def _names_something(message: str, command: Sequence[str]) -> bool:
    """Whether an error names a file or an option."""
    files = [name for _, directories, names in os.walk(".") for name in (*directories, *names)]
    words = [word for word in (*files, *command[1:]) if word.strip()]
    reason = message.partition("Error: ")[2]
    return any(word in reason for word in words) or bool(OPTION.search(reason))


def _trace(error: BaseException) -> str:
    return "".join(traceback.format_exception(error)[-12:])


@contextmanager
def _limited(limit: float) -> Iterator[None]:
    def stop(number: int, frame: FrameType | None) -> None:
        raise Hanging

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, limit)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
