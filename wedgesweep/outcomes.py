"""What became of each case of a sweep, finished or not."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from wedgesweep import config, journal
from wedgesweep.cases import describe
from wedgesweep.dataset import STATUSES
from wedgesweep.sweep import Sweep


class Outcome(NamedTuple):
    """Outcome of one case; amplitude in m, status one of dataset.STATUSES."""

    law: str
    beta: float
    amplitude: float
    status: str
    message: str

    def __str__(self) -> str:
        where = describe(self.law, self.beta, self.amplitude)
        return f"{where}: {self.status}: {self.message}"


def of_dataset(ds: xr.Dataset) -> list[Outcome]:
    """Outcomes of the cases of a dataset."""
    frame = ds[["status", "message"]].to_dataframe().reset_index()
    columns = ("friction_law", "beta", "amplitude", "status", "message")
    rows = zip(*(frame[name].tolist() for name in columns), strict=True)
    return [
        Outcome(law, beta, amplitude, STATUSES[code], message) for law, beta, amplitude, code, message in rows
    ]


def of_journal(path: Path) -> list[Outcome]:
    """Outcomes of the finished cases of an unfinished sweep."""
    settings = config.parse(journal.header(path)["config"], str(path))
    cases = settings.case_list()
    return [
        Outcome(
            **cases[record["index"]]._asdict(),
            status=STATUSES[record["status"]],
            message=record["message"].decode(),
        )
        for record in journal.read(path, Sweep(settings, path).dtype)
    ]


def counts(outcomes: Sequence[Outcome]) -> Counter[str]:
    """How many cases ended in which status."""
    return Counter(outcome.status for outcome in outcomes)


def failures(outcomes: Sequence[Outcome]) -> list[Outcome]:
    """Those that did not end well."""
    return [outcome for outcome in outcomes if outcome.status != "ok"]
