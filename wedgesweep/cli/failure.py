"""Expected errors print one message on stderr and exit with code 2; no traceback."""

import os
import signal
import socket
import sys
import threading
from types import FrameType
from typing import Any

import click

from wedgesweep.cli import messages
from wedgesweep.errors import InputError, SweepError

# Time (s) that a command has to end by itself after a signal.
GRACE = 30.0
SOME_FAILED, BAD_INPUT, OUT_OF_TIME, INTERRUPTED = 1, 2, 3, 130
# Signals that end a command as ctrl-C does; Windows has no SIGHUP.
ENDING = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))


_answered = threading.Event()


class Terminated(KeyboardInterrupt):
    """A signal of this number asked the process to end."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number


def end_on_signals() -> None:
    """Let SIGTERM and SIGHUP end this process as ctrl-C does, unless they are ignored (nohup).

    Python cannot interrupt compiled code: a process that is still there after GRACE ends at once.
    """
    for number in ENDING:
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _terminate)
    reading, writing = socket.socketpair()
    for end in (reading, writing):
        end.setblocking(end is reading)
    signal.set_wakeup_fd(writing.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=_insist, args=(reading, writing), daemon=True).start()


def _insist(reading: socket.socket, writing: socket.socket) -> None:
    """End the process some time after a signal that should have done so; ``writing`` stays open for it."""
    handled = (_terminate, signal.default_int_handler)
    while number := int.from_bytes(reading.recv(1)):
        if signal.getsignal(number) in handled and not _answered.wait(GRACE):
            os.write(2, b"interrupted at once; rerun the same command to resume\n")
            os._exit(128 + number)
        _answered.clear()


def answer() -> None:
    """Let a command that was interrupted take its time to write what it has found."""
    _answered.set()


def _terminate(number: int, frame: FrameType | None) -> None:
    raise Terminated(number)


def exit_code(interrupt: KeyboardInterrupt) -> int:
    """Exit code after an interrupt: 128 and the number of the signal."""
    return 128 + interrupt.number if isinstance(interrupt, Terminated) else INTERRUPTED


class Failure(click.ClickException):
    """An error that the user can correct."""

    exit_code = BAD_INPUT


class Commands(click.Group):
    """Command group that turns the package's own errors into messages."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)  # in the order in which they are used, not alphabetical

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        messages.begin()
        return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except (click.ClickException, click.exceptions.Exit, click.Abort, BrokenPipeError):
            raise
        except KeyboardInterrupt as interrupt:
            click.echo("interrupted", err=True)
            ctx.exit(exit_code(interrupt))
        except Exception as error:
            raise _failure(error) from error


def _failure(error: Exception) -> Exception:
    """Return the error as a message for the user; an unexpected error is returned unchanged."""
    if isinstance(error, (InputError, SweepError)):
        return Failure(str(error))
    if isinstance(error, OSError):
        described = ": ".join(str(part) for part in (error.filename, error.strerror) if part)
        return Failure(described or str(error) or type(error).__name__)
    if isinstance(error, MemoryError):
        return Failure(f"not enough memory: {error}" if str(error) else "not enough memory")
    plugins = sys.modules.get("wedgesweep.plugins")
    if plugins and (told := plugins.described(error)):
        return Failure(told)
    return error
