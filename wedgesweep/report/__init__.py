"""A diagnosis as a page that a person reads, and as one sentence."""

import os
from pathlib import Path

from wedgesweep import diagnosed
from wedgesweep.report import sentence as sentences

PAGE = "report.html"


def write(directory: Path, n_jobs: int = 1) -> Path:
    """Make report.html from the diagnosis in a directory; raises InputError if there is none.

    ``n_jobs``: processes that draw.
    """
    from wedgesweep.report import page

    file = directory / PAGE
    partial = directory / f".{PAGE}.partial"
    try:
        partial.write_text(page.render(diagnosed.read(directory), n_jobs), encoding="utf-8")
        os.replace(partial, file)
    finally:
        partial.unlink(missing_ok=True)
    return file


def sentence(directory: Path) -> str:
    """The answer of the diagnosis in a directory, as plain text."""
    return sentences.sentence(diagnosed.read(directory))
