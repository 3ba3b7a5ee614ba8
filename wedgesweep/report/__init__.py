"""The report of a diagnosis: a page that a person reads, and the answer in one sentence."""

import os
from pathlib import Path

from wedgesweep import diagnosis_result
from wedgesweep.report import sentence as sentences

PAGE = "report.html"


def write(directory: Path, n_jobs: int = 1) -> Path:
    """Write report.html into the directory of a diagnosis.

    Parameters
    ----------
    directory : pathlib.Path
        Directory that ``wedgesweep diagnose`` wrote.
    n_jobs : int, optional
        Number of processes that draw figures.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    InputError
        The directory does not hold a complete diagnosis.
    """
    from wedgesweep.report import page

    file = directory / PAGE
    partial = directory / f".{PAGE}.partial"
    try:
        partial.write_text(page.render(diagnosis_result.read(directory), n_jobs), encoding="utf-8")
        os.replace(partial, file)
    finally:
        partial.unlink(missing_ok=True)
    return file


def sentence(directory: Path) -> str:
    """Return the answer of the diagnosis in a directory as one sentence of plain text."""
    return sentences.sentence(diagnosis_result.read(directory))
