"""How each case of a sweep ended, whether the sweep is finished or not."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from wedgesweep import config
from wedgesweep.errors import SweepError
from wedgesweep.outcome import Outcome, settled
from wedgesweep.sweep import journal
from wedgesweep.sweep.cases import describe
from wedgesweep.sweep.run import Sweep

LIFT_OFF = "lift_off_fraction"
# A variable of unilateral joints.
OPENS = "column_open_fraction"


class CaseResult(NamedTuple):
    """How one case ended; amplitude in ``unit``, m or N.

    ``period``, ``periodicity`` and ``lift_off_fraction`` are the dataset's variables of these names.
    """

    law: str
    beta: float
    amplitude: float
    status: Outcome
    message: str
    period: int
    periodicity: float
    lift_off_fraction: float
    unit: str = "m"

    @property
    def settled(self) -> bool:
        """Whether the case has reached a steady response."""
        return bool(settled(self.period, self.periodicity))

    @property
    def lifted(self) -> bool:
        """Whether a joint that should lift off was held: the model is outside of its validity."""
        return self.lift_off_fraction > 0.0

    def __str__(self) -> str:
        where = describe(self.law, self.beta, self.amplitude, self.unit)
        return f"{where}: {self.status}: {self.message}"


def of_dataset(ds: xr.Dataset) -> list[CaseResult]:
    """How each case of a dataset ended."""
    if LIFT_OFF not in ds or OPENS in ds:  # normal forces are given, or joints may lift off
        ds = ds.assign({LIFT_OFF: xr.zeros_like(ds["periodicity"])})
    frame = ds[["status", "message", "period", "periodicity", LIFT_OFF]].to_dataframe().reset_index()
    frame = frame.rename(columns={"friction_law": "law"})
    frame["unit"] = ds["amplitude"].attrs.get("units", "m")
    columns = {name: frame[name].tolist() for name in CaseResult._fields}
    columns["status"] = map(Outcome, columns["status"])
    return list(map(CaseResult, *columns.values()))


def of_journal(path: Path) -> list[CaseResult]:
    """How the finished cases of an unfinished sweep ended."""
    header = journal.header(path)
    settings = config.parse(header["config"], str(path))
    if settings.sha256 != header["config_sha256"]:
        message = f"{path}: damaged in its first line, whose config is not that of the records"
        raise SweepError(message)
    cases = settings.case_list()
    return [
        CaseResult(
            **cases[record["index"]]._asdict(),
            status=Outcome(record["status"]),
            message=record["message"].decode(),
            period=int(record["period"]),
            periodicity=float(record["periodicity"]),
            lift_off_fraction=0.0 if settings.opens else float(record[LIFT_OFF]),
            unit="N" if settings.forced else "m",
        )
        for record in journal.read(path, Sweep(settings, path).dtype)
    ]


def counts(results: Sequence[CaseResult]) -> Counter[Outcome]:
    """Number of cases with each outcome."""
    return Counter(result.status for result in results)


def failures(results: Sequence[CaseResult]) -> list[CaseResult]:
    """Cases that failed."""
    return [result for result in results if result.status != Outcome.OK]


def unsettled(results: Sequence[CaseResult]) -> list[CaseResult]:
    """Cases that were solved, but did not reach a steady response."""
    return [result for result in results if result.status == Outcome.OK and not result.settled]


def lifted(results: Sequence[CaseResult]) -> list[CaseResult]:
    """Cases that were solved, but lie outside of the model's validity."""
    return [result for result in results if result.status == Outcome.OK and result.lifted]
