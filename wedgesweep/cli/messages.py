"""What commands say beside their results: on stderr, through logging, under --quiet and --verbose."""

import logging
import sys
from typing import Any

import click

log = logging.getLogger("wedgesweep")
# Clears the line of the terminal that shows progress.
_WIPE = "\r\x1b[2K"


class _OnStderr(logging.Handler):
    """Prints messages as they are; those for --verbose with the module that sends them."""

    status = ""

    def emit(self, record: logging.LogRecord) -> None:
        origin = f"[{record.name}] " if record.levelno <= logging.DEBUG else ""
        click.echo(_WIPE * bool(self.status) + origin + record.getMessage(), err=True)
        click.echo(self.status, nl=False, err=True)


_handler = _OnStderr()


def begin() -> None:
    """Show messages of normal importance until a command's options say otherwise."""
    if _handler not in log.handlers:
        log.addHandler(_handler)
    log.propagate = False
    _handler.status = ""
    log.setLevel(logging.INFO)


def shows_status() -> bool:
    """Whether there is a terminal with a line for progress."""
    return sys.stderr.isatty() and log.isEnabledFor(logging.INFO)


def show_status(text: str) -> None:
    """Write over the line of the terminal that shows progress; "" removes it."""
    if shows_status() and text != _handler.status:
        click.echo(_WIPE + text, nl=False, err=True)
        _handler.status = text


def _choose(ctx: click.Context, param: click.Parameter, given: bool) -> None:
    if not given:
        return
    if log.level != logging.INFO:
        raise click.UsageError("--quiet and --verbose contradict each other; leave one out")
    log.setLevel(logging.WARNING if param.name == "quiet" else logging.DEBUG)


def with_verbosity(command: Any) -> Any:
    """Add --quiet and --verbose to a command."""
    options = (
        ("quiet", "Print results, warnings and errors only: no notes, no progress."),
        ("verbose", "Also print what is read, solved and written."),
    )
    for name, meaning in options:
        command.params.append(
            click.Option([f"--{name}"], is_flag=True, expose_value=False, callback=_choose, help=meaning)
        )
    return command
