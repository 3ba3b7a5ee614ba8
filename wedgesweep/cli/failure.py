"""Expected errors print one message on stderr and exit with code 2; no traceback."""

from typing import Any

import click

from wedgesweep.errors import InputError, SweepError

SOME_FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130


class Failure(click.ClickException):
    """An error that the user can correct."""

    exit_code = BAD_INPUT


class Commands(click.Group):
    """Command group that turns the package's own errors into messages."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)  # in the order in which they are used, not alphabetical

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except (click.ClickException, click.exceptions.Exit, click.Abort, BrokenPipeError):
            raise
        except KeyboardInterrupt:
            click.echo("interrupted", err=True)
            ctx.exit(INTERRUPTED)
        except Exception as error:
            raise _failure(error) from error


def _failure(error: Exception) -> Exception:
    """Return the error as a message for the user; an unexpected error is returned unchanged."""
    if isinstance(error, (InputError, SweepError)):
        return Failure(str(error))
    if isinstance(error, OSError):
        told = ": ".join(str(part) for part in (error.filename, error.strerror) if part)
        return Failure(told or str(error) or type(error).__name__)
    return error
