"""export: a dataset as CSV, a row for each case."""

import csv
import io
from pathlib import Path

import click

from wedgesweep.cli.options import DATASET, STANDARD_OUTPUT, OutputPath
from wedgesweep.cli.plot import read_dataset
from wedgesweep.files import CSV, written
from wedgesweep.formatting import counted


@click.command()
@DATASET
@click.option(
    "-o",
    "--output",
    type=OutputPath(CSV, allow_dash=True),
    help="CSV file to write, - to print; default: OUT's name with .csv, in the current directory.",
)
@click.option(
    "--variables", metavar="A,B,...", help="Variables to write; default: all with one value a case."
)
def export(path: Path, output: Path | None, variables: str | None) -> None:
    """Write the dataset OUT as CSV, a row for each case.

    Numbers are in SI units, which the header states. Cases that failed have their status and message, and no
    numbers. Cases that an unfinished run has not solved yet have the status not_run.
    """
    from wedgesweep.sweep import table

    ds = read_dataset(path)
    chosen = None if variables is None else [name.strip() for name in variables.split(",") if name.strip()]
    rows = table.rows(ds, table.variables_of(ds, chosen))
    file = output or Path(f"{path.stem}.csv")
    if file == STANDARD_OUTPUT:
        for some in rows:
            click.echo(_text(some), nl=False)
        return
    with written(file) as temporary, temporary.open("w", encoding="utf-8", newline="") as stream:
        for some in rows:
            stream.write(_text(some))
    click.echo(f"wrote {file}: {counted(ds['status'].size, 'case')}")


def _text(rows: list[list[str]]) -> str:
    made = io.StringIO()
    csv.writer(made, lineterminator="\n").writerows(rows)
    return made.getvalue()
