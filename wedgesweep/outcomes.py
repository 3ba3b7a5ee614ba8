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

# A case has settled if its last two periods differ by less than this share of the input amplitude.
SETTLED = 1e-3


class Outcome(NamedTuple):
    """Outcome of one case; amplitude in m, status one of dataset.STATUSES.

    ``period`` and ``periodicity``: the dataset's variables of these names.
    """

    law: str
    beta: float
    amplitude: float
    status: str
    message: str
    period: int
    periodicity: float

    @property
    def settled(self) -> bool:
        """Whether the response repeats, or all but does where nobody looked for its period."""
        return self.period > 0 if self.period >= 0 else self.periodicity <= SETTLED

    def __str__(self) -> str:
        where = describe(self.law, self.beta, self.amplitude)
        return f"{where}: {self.status}: {self.message}"


def of_dataset(ds: xr.Dataset) -> list[Outcome]:
    """Outcomes of the cases of a dataset."""
    frame = ds[["status", "message", "period", "periodicity"]].to_dataframe().reset_index()
    frame = frame.rename(columns={"friction_law": "law"})
    frame["status"] = [STATUSES[code] for code in frame["status"]]
    rows = zip(*(frame[name].tolist() for name in Outcome._fields), strict=True)
    return list(map(Outcome._make, rows))


def of_journal(path: Path) -> list[Outcome]:
    """Outcomes of the finished cases of an unfinished sweep."""
    settings = config.parse(journal.header(path)["config"], str(path))
    cases = settings.case_list()
    return [
        Outcome(
            **cases[record["index"]]._asdict(),
            status=STATUSES[record["status"]],
            message=record["message"].decode(),
            period=int(record["period"]),
            periodicity=float(record["periodicity"]),
        )
        for record in journal.read(path, Sweep(settings, path).dtype)
    ]


def counts(outcomes: Sequence[Outcome]) -> Counter[str]:
    """How many cases ended in which status."""
    return Counter(outcome.status for outcome in outcomes)


def failures(outcomes: Sequence[Outcome]) -> list[Outcome]:
    """Those that did not end well."""
    return [outcome for outcome in outcomes if outcome.status != "ok"]


def unsettled(outcomes: Sequence[Outcome]) -> list[Outcome]:
    """Those that ended well, but not in a steady response."""
    return [outcome for outcome in outcomes if outcome.status == "ok" and not outcome.settled]
