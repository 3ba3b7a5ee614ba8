"""Errors that a user can correct."""


class InputError(Exception):
    """Input that cannot be used; ``problems`` lists everything that is wrong with it, a line each."""

    def __init__(self, problems: list[str]) -> None:
        super().__init__(problems)
        self.problems = problems

    def __str__(self) -> str:
        return "\n".join(self.problems)


class ConfigError(InputError):
    """A config cannot run; ``problems`` lists all its faults."""


class SweepError(Exception):
    """A sweep cannot start, go on, be stored or be read; the message says why."""


class MismatchError(SweepError):
    """Stored results belong to a sweep with another config or version."""
