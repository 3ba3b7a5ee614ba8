"""Expected errors become one message on stderr and exit code 2, never a traceback."""

from typing import Any

import click

from wedgesweep.errors import InputError, SweepError

SOME_FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130


class Failure(click.ClickException):
    """Something that the user can put right."""

    exit_code = BAD_INPUT


class Commands(click.Group):
    """Group of commands that reports the package's own errors."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)  # in the order of a user's work, not of the alphabet

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
    """The same error for the user; an unexpected one stays as it is."""
    if isinstance(error, (InputError, SweepError)):
        return Failure(str(error))
    if isinstance(error, OSError):
        told = ": ".join(str(part) for part in (error.filename, error.strerror) if part)
        return Failure(told or str(error) or type(error).__name__)
    return error
