"""diagnose: find what the model of measured data misses, or say why that cannot be found."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from wedgesweep.cli.compiling import announce_compiling
from wedgesweep.cli.failure import Failure
from wedgesweep.cli.measurement import print_warnings
from wedgesweep.cli.messages import log
from wedgesweep.cli.options import N_JOBS, GivenPath, require_kind, require_place_for
from wedgesweep.cli.steps import StepReport
from wedgesweep.files import beside
from wedgesweep.kinds import MEASURED

if TYPE_CHECKING:
    from wedgesweep.diagnosis_result import DiagnosisResult

DRAWN = ("misfit", "loops", "decays", "spectrogram", "candidates", "ladder", "gain")
FIGURE_FILES = {kind: f"{kind}.png" for kind in DRAWN}
# Marks a directory in which an earlier result is being replaced.
REPLACING = ".unfinished-diagnosis"
# Figures of one kind of test only.
OF_KIND = {"misfit": "steady", "loops": "loop", "decays": "transient", "spectrogram": "transient"}


@click.command()
@click.argument("measured", type=GivenPath(exists=True, dir_okay=False))
@click.option(
    "--model",
    type=GivenPath(exists=True, dir_okay=False),
    help="Config of the base model, instead of the one that MEASURED names.",
)
@click.option(
    "-o",
    "--output",
    type=GivenPath(file_okay=False),
    help="Directory of the result; default: MEASURED's name (for measured.toml that of its directory) with "
    "-diagnosis, in the current directory.",
)
@N_JOBS
@click.option("--effects", metavar="A,B,...", help="Candidate effects; default: all.")
@click.option(
    "--report/--no-report",
    "reported",
    default=True,
    help="Whether to write report.html and the figures (default) besides the data.",
)
@click.option("--calibrate", is_flag=True, help="Calibrate the thresholds by simulation (minutes).")
def diagnose(
    measured: Path,
    model: Path | None,
    output: Path | None,
    n_jobs: int | None,
    effects: str | None,
    reported: bool,
    calibrate: bool,
) -> None:
    """Find the physical effects that a model misses.

    MEASURED is a measured.toml, which names the model and the files of the tests.
    """
    from wedgesweep import api, report
    from wedgesweep.sweep.backend import count_jobs

    require_kind(measured, MEASURED)
    measurement = api.read_measurement(measured, model)
    print_warnings(measurement)
    log.debug(f"{measured}: {len(measurement.tests)} tests, model {measurement.model.title}")
    directory = output or Path(f"{_name(measured)}-diagnosis")
    require_place_for(directory)
    _require_own(directory)
    processors = count_jobs(n_jobs)
    announce_compiling()
    steps = StepReport()
    try:
        found = api.diagnose_measurement(
            measurement, effects=_names(effects), n_jobs=processors, progress=steps, calibrate=calibrate
        )
    finally:
        steps.stop()
    _store(found, directory, reported, processors)
    click.echo(report.sentence(directory))
    click.echo(f"wrote {directory / report.PAGE if reported else directory}")


def _store(found: "DiagnosisResult", directory: Path, reported: bool, n_jobs: int) -> None:
    """Write a result beside its directory, and replace an earlier one only when all is written."""
    from wedgesweep import report

    target = directory.resolve()
    target.parent.mkdir(parents=True, exist_ok=True)
    with beside(target) as made:
        found.write(made)
        if reported:
            _draw(found, made, n_jobs)
            report.write(made, n_jobs)
        _move(made, target)


def _names(listed: str | None) -> list[str] | None:
    return None if listed is None else [name.strip() for name in listed.split(",") if name.strip()]


def _name(measured: Path) -> str:
    return measured.resolve().parent.name if measured.name == "measured.toml" else measured.stem


def _require_own(directory: Path) -> None:
    """Refuse to overwrite files that have the names of a result, but are not from a diagnosis."""
    mark, *others = _result_files()
    foreign = [name for name in others if (directory / name).exists()]
    if foreign and not any((directory / each).is_file() for each in (mark, REPLACING)):
        message = f"{directory / foreign[0]}: not the result of a diagnosis; choose another -o to keep it"
        raise Failure(message)


def _result_files() -> tuple[str, ...]:
    """Names of the files of a result; the first marks it as complete."""
    from wedgesweep import diagnosis_result, report

    data = (diagnosis_result.JSON, diagnosis_result.DATASET, diagnosis_result.EXTENDED)
    return (*data, *diagnosis_result.PARTS.values(), report.PAGE, *FIGURE_FILES.values())


def _move(made: Path, directory: Path) -> None:
    """Replace an earlier result by a complete one; between the two there is no verdict."""
    first, *others = _result_files()
    directory.mkdir(exist_ok=True)
    # If this process is killed now, the next one still sees that the files are from a diagnosis.
    (directory / REPLACING).touch()
    (directory / first).unlink(missing_ok=True)
    for name in (*others, first):
        if (made / name).exists():
            (made / name).replace(directory / name)
        else:
            (directory / name).unlink(missing_ok=True)
    (directory / REPLACING).unlink()


def _draw(found: "DiagnosisResult", directory: Path, n_jobs: int) -> None:
    """Write the figures; skip those that need more than these tests give."""
    from wedgesweep.figures import parallel

    kind_of_tests = found.document["kind"]
    kinds = (kind_of_tests, *found.parts)
    wanted = [
        (kind, directory / file)
        for kind, file in FIGURE_FILES.items()
        if OF_KIND.get(kind, kind_of_tests) in kinds
    ]
    save = partial(_save, found)
    for problem in filter(None, parallel.map_forked(save, wanted, n_jobs)):
        log.info(f"skipped {problem}")


def _save(found: "DiagnosisResult", wanted: tuple[str, Path]) -> str | None:
    """Write a figure, or return why it cannot be drawn from these tests."""
    from wedgesweep import figures

    kind, file = wanted
    try:
        figures.save(figures.draw(found.of_kind(OF_KIND.get(kind, "")), kind), file)
    except ValueError as error:
        return str(error)
    return None
