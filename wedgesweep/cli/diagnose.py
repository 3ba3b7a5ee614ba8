"""diagnose: find what the model of measured data misses, or say why that cannot be found."""

from functools import partial
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from wedgesweep.cli import failure
from wedgesweep.cli.compiling import announce_compiling
from wedgesweep.cli.failure import Failure
from wedgesweep.cli.measurement import print_noise, print_warnings
from wedgesweep.cli.messages import log
from wedgesweep.cli.options import N_JOBS, PLUGIN, Duration, GivenPath, require_kind, require_place_for
from wedgesweep.cli.progress import ProgressReport
from wedgesweep.files import beside
from wedgesweep.kinds import MEASURED

if TYPE_CHECKING:
    from wedgesweep.diagnosis_result import DiagnosisResult

# Figures that are written, as far as the tests are of their kind.
FIGURES = ("misfit", "loops", "decays", "spectrogram", "candidates", "ladder", "gain", "missing-force")
# Marks a directory in which an earlier result is being replaced.
REPLACING = ".unfinished-diagnosis"


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
@PLUGIN
@click.option("--effects", metavar="A,B,...", help="Candidate effects; default: all.")
@click.option(
    "--report/--no-report",
    "reported",
    default=True,
    help="Whether to write report.html and the figures (default) besides the data.",
)
@click.option("--calibrate", is_flag=True, help="Calibrate the thresholds by simulation (minutes).")
@click.option(
    "--empirical-force",
    is_flag=True,
    help="Fit the missing force as a table even if a name explains it; without this only where none does.",
)
@click.option(
    "--time-limit",
    type=Duration(),
    default=inf,
    show_default="none",
    help="End the fits after this time (60s, 10min, 1h) and report what was found by then.",
)
@click.pass_context
def diagnose(
    ctx: click.Context, measured: Path, model: Path | None, output: Path | None, **options: Any
) -> None:
    """Find the physical effects that a model misses.

    MEASURED is a measured.toml, which names the model and the files of the tests.
    The result is written as it is reached: an interrupt (ctrl-C) or the time limit ends in a report of what
    was found.
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
    print_noise(measurement)
    processors, results = count_jobs(options["n_jobs"]), Results(directory)
    announce_compiling()
    progress = ProgressReport()
    try:
        found = api.diagnose_measurement(
            measurement,
            effects=_names(options["effects"], options["empirical_force"]),
            n_jobs=processors,
            progress=progress.step,
            calibrate=options["calibrate"],
            time_limit_s=options["time_limit"],
            reached=results,
        )
    finally:
        progress.stop()
    ended = found.document.get("ended")
    if ended is not None:
        failure.answer()
    reported = results.complete(found, processors if options["reported"] else 0)
    if ended is not None:
        log.info(f"ended early ({ended['by']}); this is the result so far")
    click.echo(report.sentence(directory))
    click.echo(f"wrote {directory / report.PAGE if reported else directory}")
    if ended is not None:
        ctx.exit(128 + ended["signal"] if ended["signal"] else failure.OUT_OF_TIME)


@click.command("report")
@click.argument("directory", metavar="DIR", type=GivenPath(exists=True, file_okay=False))
@N_JOBS
@PLUGIN
def write_report(directory: Path, n_jobs: int | None) -> None:
    """Write the report of a diagnosis again, or of one that was killed.

    DIR is the directory of a diagnosis; its diagnosis.json holds what was known when it ended.
    """
    from wedgesweep import report
    from wedgesweep.sweep.backend import count_jobs

    file = report.write(directory, count_jobs(n_jobs))
    click.echo(report.sentence(directory))
    click.echo(f"wrote {file}")


class Results:
    """The result of a diagnosis in its directory, replaced whenever more is known."""

    def __init__(self, directory: Path) -> None:
        self._target, self._begun = directory.resolve(), False

    def __call__(self, found: "DiagnosisResult") -> None:
        """Tell the misfit of the base model first; write the result once single effects are fitted."""
        from wedgesweep.report import phrases

        if len(found.document["ladder"]) > 1:
            self._store(found)
        elif not self._begun:
            log.info(f"base model: error {phrases.error_of(found, 'base')} times the noise")

    def complete(self, found: "DiagnosisResult", n_jobs: int) -> bool:
        """Write the last result, then its report and figures if any ``n_jobs`` processes draw them.

        Returns whether there is a report.
        """
        self._store(found)
        if n_jobs:
            try:
                self._store(found, n_jobs)
            except Exception as error:  # the result is there all the same
                log.warning(f"no report ({type(error).__name__}: {error}); 'wedgesweep report' tries again")
                return False
        return n_jobs > 0

    def _store(self, found: "DiagnosisResult", n_jobs: int = 0) -> None:
        """Write a result beside its directory, and replace an earlier one only when all is written."""
        from wedgesweep import report

        self._target.parent.mkdir(parents=True, exist_ok=True)
        with beside(self._target) as made:
            found.write(made)
            if n_jobs:
                _draw(found, made, n_jobs)
                report.write(made, n_jobs)
            _move(made, self._target, self._begun)
        self._begun = True


def _names(listed: str | None, with_force: bool) -> list[str] | None:
    """Names of the candidates, and of the empirical force where it is wanted whatever the verdict is."""
    from wedgesweep.effects import candidates, empirical_force

    if listed is None and not with_force:
        return None
    names = candidates() if listed is None else (name.strip() for name in listed.split(","))
    return [*filter(None, names), *[empirical_force.NAME] * with_force]


def _name(measured: Path) -> str:
    return measured.resolve().parent.name if measured.name == "measured.toml" else measured.stem


def _require_own(directory: Path) -> None:
    """Refuse to overwrite files that have the names of a result, but are not from a diagnosis."""
    mark, *others = _result_files()
    foreign = [name for name in others if (directory / name).exists()]
    if foreign and not any((directory / each).is_file() for each in (mark, REPLACING)):
        raise Failure(
            f"{directory / foreign[0]}: not the result of a diagnosis; choose another -o to keep it"
        )


def _result_files() -> tuple[str, ...]:
    """Names of the files of a result; the first marks it as complete."""
    from wedgesweep import diagnosis_result, report

    data = (diagnosis_result.JSON, diagnosis_result.DATASET, diagnosis_result.EXTENDED)
    force = (diagnosis_result.FORCE_CONFIG, diagnosis_result.FORCE_TABLE)
    return (*data, *force, *diagnosis_result.PARTS.values(), report.PAGE, *map(_file_of, FIGURES))


def _move(made: Path, directory: Path, renews: bool = False) -> None:
    """Replace an earlier result.

    Between the result of another diagnosis and this one there is no verdict; one that ``renews`` its own
    earlier result leaves that until the new one is there.
    """
    first, *others = _result_files()
    directory.mkdir(exist_ok=True)
    # If this process is killed now, the next one still sees that the files are from a diagnosis.
    (directory / REPLACING).touch()
    if not renews:
        (directory / first).unlink(missing_ok=True)
    for name in (*others, first):
        if (made / name).exists():
            (made / name).replace(directory / name)
        else:
            (directory / name).unlink(missing_ok=True)
    (directory / REPLACING).unlink()


def _draw(found: "DiagnosisResult", directory: Path, n_jobs: int) -> None:
    """Write the figures; skip those that need more than these tests give."""
    from wedgesweep.figures import diagnosis, parallel

    kinds = ("", found.document["kind"], *found.parts)
    wanted = [name for name in FIGURES if diagnosis.FIGURES[name].tests in kinds]
    save = partial(_save, found, directory)
    for problem in filter(None, parallel.map_forked(save, wanted, n_jobs)):
        log.info(f"skipped {problem}")


def _save(found: "DiagnosisResult", directory: Path, name: str) -> str | None:
    """Write a figure, or return why it cannot be drawn from these tests."""
    from wedgesweep import figures

    try:
        figures.save(figures.draw(found, name), directory / _file_of(name))
    except ValueError as error:
        return str(error)
    return None


def _file_of(figure: str) -> str:
    return f"{figure}.png"
