"""Results of an unfinished sweep, read from its journal."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import xarray as xr

from wedgesweep import config
from wedgesweep.config import Config
from wedgesweep.errors import SweepError
from wedgesweep.sweep import journal, variables
from wedgesweep.sweep.dataset import journal_of
from wedgesweep.sweep.run import Sweep


def dataset_of(out: Path, waveforms: bool = True) -> xr.Dataset:
    """Dataset of an interrupted run to ``out``, with status not_run where nothing is known yet.

    Raises SweepError if its journal is damaged.
    """
    sweep, done = _begun(out)
    if not waveforms:
        solver = sweep.config.document["solver"] | {"keep_waveforms": False}
        sweep = Sweep(Config(sweep.config.document | {"solver": solver}), out)
    records = variables.blank(sweep.dtype, np.arange(sweep.count))
    names = list(sweep.dtype.names or ())
    records[done["index"]] = done[names]
    return sweep.assembled(records, datetime.now(UTC))


def _begun(out: Path) -> tuple[Sweep, np.ndarray]:
    """An unfinished sweep, and the records of its finished cases."""
    path = journal_of(out)
    header = journal.header(path)
    settings = config.parse(header["config"], str(path))
    if settings.sha256 != header["config_sha256"]:
        raise SweepError(f"{path}: damaged in its first line, whose config is not that of the records")
    sweep = Sweep(settings, out)
    return sweep, journal.read(path, sweep.dtype)
