"""The command line, called as a user would."""

from click.testing import CliRunner

from wedgesweep.cli import cli


def invoke(*arguments: object, code: int = 0) -> str:
    """Output (stdout and stderr) of a command, which must end with this exit code."""
    result = CliRunner().invoke(cli, [str(argument) for argument in arguments])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == code, result.output
    return result.output
