"""How each case of a sweep ended, whether the sweep is finished or not."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from wedgesweep import config
from wedgesweep.errors import SweepError
from wedgesweep.outcome import Outcome
from wedgesweep.sweep import journal
from wedgesweep.sweep.cases import describe
from wedgesweep.sweep.run import Sweep

# A case has settled if its last two periods differ by less than this share of the input amplitude.
SETTLED = 1e-3


class CaseResult(NamedTuple):
    """How one case ended; amplitude in ``unit``, m or N.

    ``period`` and ``periodicity`` are the dataset's variables of these names.
    """

    law: str
    beta: float
    amplitude: float
    status: Outcome
    message: str
    period: int
    periodicity: float
    unit: str = "m"

    @property
    def settled(self) -> bool:
        """Whether the response repeats; if no period was looked for, whether its last two periods agree."""
        return self.period > 0 if self.period >= 0 else self.periodicity <= SETTLED

    def __str__(self) -> str:
        where = describe(self.law, self.beta, self.amplitude, self.unit)
        return f"{where}: {self.status}: {self.message}"


def of_dataset(ds: xr.Dataset) -> list[CaseResult]:
    """How each case of a dataset ended."""
    frame = ds[["status", "message", "period", "periodicity"]].to_dataframe().reset_index()
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
