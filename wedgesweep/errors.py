"""The error of everything around the cases: files, journals, sweeps that do not fit together."""


class SweepError(Exception):
    """A sweep that cannot start, go on, be stored or be read; the message says why."""


class MismatchError(SweepError):
    """What is stored belongs to a sweep of another config, version or machine set-up."""
