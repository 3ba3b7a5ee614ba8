"""status: progress of a sweep, whether complete, interrupted or running."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from wedgesweep.cli.failure import Failure
from wedgesweep.cli.options import DATASET
from wedgesweep.cli.summary import print_summary
from wedgesweep.files import json_object

if TYPE_CHECKING:
    import xarray as xr

VERSIONS = ("wedgesweep", "python", "numpy", "scipy", "numba")


@click.command()
@DATASET
@click.pass_context
def status(ctx: click.Context, path: Path) -> None:
    """Show how far a sweep is, and which cases failed.

    OUT is the dataset that it writes, or has written.
    """
    if path.is_dir():
        raise Failure(f"{path}: a directory; give the dataset of a run")
    from wedgesweep.sweep.dataset import journal_of

    ctx.exit(_unfinished(path) if journal_of(path).exists() else _finished(path))


def _finished(path: Path) -> int:
    from wedgesweep.sweep import dataset

    ds = dataset.read_sweep(path)
    click.echo(f"{path}: complete\ntitle: {ds.attrs.get('title', 'none')}")
    if "start_time" in ds.attrs:
        click.echo(f"started: {ds.attrs['start_time']}")
    _print_versions(_fingerprint(ds))
    return print_summary(ds)


def _unfinished(path: Path) -> int:
    from wedgesweep import config
    from wedgesweep.sweep import journal, unfinished
    from wedgesweep.sweep.dataset import journal_of
    from wedgesweep.sweep.fingerprint import differences, fingerprint

    partial = journal_of(path)
    header = journal.header(partial)
    settings = config.parse(header["config"], str(partial))
    click.echo(f"{partial}: unfinished\ntitle: {settings.title}")
    _print_versions(header)
    for difference in differences(header, fingerprint(settings)):
        click.echo(f"cannot be resumed: {difference}")
    return print_summary(unfinished.dataset_of(path, waveforms=False))


def _fingerprint(ds: "xr.Dataset") -> dict[str, str]:
    try:
        return json_object(ds.attrs.get("fingerprint", "{}"))
    except (TypeError, ValueError):
        return {}


def _print_versions(found: Mapping[str, str]) -> None:
    versions = (f"{name} {found[name]}" for name in VERSIONS if name in found)
    click.echo(f"versions: {', '.join(versions)}")
