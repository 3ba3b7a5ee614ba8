"""The errors that a user can put right: bad input, and everything around the cases of a sweep."""


class InputError(Exception):
    """Input that cannot be used; ``problems`` lists all that is wrong with it, a line each."""

    def __init__(self, problems: list[str]) -> None:
        super().__init__(problems)
        self.problems = problems

    def __str__(self) -> str:
        return "\n".join(self.problems)


class SweepError(Exception):
    """A sweep that cannot start, go on, be stored or be read; the message says why."""


class MismatchError(SweepError):
    """What is stored belongs to a sweep of another config, version or machine set-up."""
