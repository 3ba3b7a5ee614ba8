"""The report of a diagnosis: a page that a person reads, and the answer in one sentence."""

from pathlib import Path

from wedgesweep import diagnosis_result
from wedgesweep.files import write_text
from wedgesweep.report.sentence import sentence as sentence_of

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
    write_text(file, page.render(diagnosis_result.read(directory), n_jobs))
    return file


def sentence(directory: Path) -> str:
    """Return the answer of the diagnosis in a directory as one sentence of plain text."""
    return sentence_of(diagnosis_result.read(directory))
