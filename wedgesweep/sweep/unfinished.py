"""Results of an unfinished sweep, read from its journal."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import xarray as xr

from wedgesweep import config
from wedgesweep.config import Case
from wedgesweep.errors import SweepError
from wedgesweep.sweep import journal, variables
from wedgesweep.sweep.dataset import journal_of
from wedgesweep.sweep.outcomes import COLUMNS, LIFT_OFF, Outcomes
from wedgesweep.sweep.run import Sweep


def dataset_of(out: Path) -> xr.Dataset:
    """Dataset of an interrupted run to ``out``, with status not_run where nothing is known yet.

    Raises SweepError if its journal is damaged, as ``outcomes_of`` does.
    """
    sweep, done = _begun(out)
    records = variables.blank(sweep.dtype, np.arange(sweep.count))
    records[done["index"]] = done
    return sweep.assembled(records, datetime.now(UTC))


def outcomes_of(out: Path) -> Outcomes:
    """How the finished cases of an unfinished sweep ended."""
    sweep, records = _begun(out)
    settings = sweep.config

    def described(place: int) -> tuple[Case, str, str]:
        case = settings.sweep.case(records["index"][place])
        return case, settings.case_unit, records["message"][place].decode()

    nothing = np.zeros(len(records))
    lifted = nothing if settings.opens else records[LIFT_OFF]
    if settings.transient:
        return Outcomes(records["status"], nothing + 1.0, nothing, lifted, described)
    columns = {name: records[name] for name in COLUMNS} | {LIFT_OFF: lifted}
    return Outcomes(**columns, describe_case=described)


def _begun(out: Path) -> tuple[Sweep, np.ndarray]:
    """An unfinished sweep, and the records of its finished cases."""
    path = journal_of(out)
    header = journal.header(path)
    settings = config.parse(header["config"], str(path))
    if settings.sha256 != header["config_sha256"]:
        message = f"{path}: damaged in its first line, whose config is not that of the records"
        raise SweepError(message)
    sweep = Sweep(settings, out)
    return sweep, journal.read(path, sweep.dtype)
