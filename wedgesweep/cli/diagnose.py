"""diagnose: measured data in, a named cause (or an honest refusal) out."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from wedgesweep.cli.failure import Failure
from wedgesweep.cli.options import N_JOBS, require_place_for

if TYPE_CHECKING:
    from wedgesweep.diagnosis_result import DiagnosisResult

FIGURE_FILES = {kind: f"{kind}.png" for kind in ("misfit", "candidates", "gain")}


@click.command()
@click.argument("measured", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option(
    "--model",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Config of the model on trial, instead of the one that MEASURED names.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    help="Directory of the result; default: MEASURED's name (its directory's, if that is measured.toml) "
    "with -diagnosis, here.",
)
@N_JOBS
@click.option("--effects", metavar="A,B,...", help="Only these candidates; default: all.")
@click.option(
    "--report/--no-report",
    "reported",
    default=True,
    help="With report.html and figures (default), or the data alone.",
)
@click.option("--calibrate", is_flag=True, help="Thresholds by simulation of these very tests (minutes).")
def diagnose(
    measured: Path,
    model: Path | None,
    output: Path | None,
    n_jobs: int | None,
    effects: str | None,
    reported: bool,
    calibrate: bool,
) -> None:
    """Say what the simulation of the data in MEASURED gets wrong, and why.

    MEASURED is a measured.toml with its CSV files, or the same as one netCDF file.
    """
    chosen = _chosen(effects)
    from wedgesweep import measured as data
    from wedgesweep import report
    from wedgesweep.diagnose import diagnosis, result
    from wedgesweep.sweep.backend import count_jobs

    measurement = data.read(measured, model)
    directory = output or Path(f"{_name(measured)}-diagnosis")
    require_place_for(directory)
    processors = count_jobs(n_jobs)
    found = diagnosis.diagnose(measurement, chosen, processors, _said, calibrate)
    _clear(directory)
    result.write(found, directory)
    written = directory
    if reported:
        _draw(directory, processors)
        written = report.write(directory, processors)
    click.echo(report.sentence(directory))
    click.echo(f"wrote {written}")


def _name(measured: Path) -> str:
    return measured.resolve().parent.name if measured.name == "measured.toml" else measured.stem


def _clear(directory: Path) -> None:
    """Remove what an older diagnosis drew here: it does not belong to the new one."""
    from wedgesweep import report

    for name in (report.PAGE, *FIGURE_FILES.values()):
        (directory / name).unlink(missing_ok=True)


def _draw(directory: Path, n_jobs: int) -> None:
    """Write the figures beside the data; one that the tests cannot fill is left out."""
    from wedgesweep import diagnosis_result
    from wedgesweep.figures import parallel

    wanted = [(kind, directory / file) for kind, file in FIGURE_FILES.items()]
    save = partial(_save, diagnosis_result.read(directory))
    for problem in filter(None, parallel.map_forked(save, wanted, n_jobs)):
        click.echo(f"skipped {problem}", err=True)


def _save(found: "DiagnosisResult", wanted: tuple[str, Path]) -> str | None:
    """Write a figure; returns why the tests cannot fill it, if they cannot."""
    from wedgesweep import figures

    kind, file = wanted
    try:
        figures.save(figures.draw(found, kind), file)
    except ValueError as error:
        return str(error)
    return None


def _said(step: str) -> None:
    click.echo(f"  {step}", err=True)


def _chosen(effects: str | None) -> tuple[str, ...]:
    from wedgesweep.config.keys import hint
    from wedgesweep.effects import EFFECTS

    if effects is None:
        return tuple(EFFECTS)
    names = tuple(name.strip() for name in effects.split(",") if name.strip())
    unknown = [name for name in names if name not in EFFECTS]
    if not names:
        message = f"--effects: nothing is chosen; valid here: {', '.join(EFFECTS)}"
        raise Failure(message)
    if unknown:
        message = "\n".join(f"--effects: unknown effect {name}; {hint(name, EFFECTS)}" for name in unknown)
        raise Failure(message)
    return names
