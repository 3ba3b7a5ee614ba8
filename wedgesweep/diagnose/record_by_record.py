"""Explanations fitted to each record by itself.

What loads a contact (a pressure, a weight, a temperature) may differ from record to record, and the model on
trial not know it. Then one number in all records leaves that difference, and a right cause looks inaccurate.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose import accuracy
from wedgesweep.diagnose.ladder import Level, Rated
from wedgesweep.diagnose.least_squares import subset_fit
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.search import Search

NAME = "record by record"
# The most accurate effects of a level that are fitted to each record by itself.
COMPARED = 3
# It is told if it leaves this share of what one number in all records leaves: less is gained by any effect,
# as several numbers fit better than one.
LEFT = 2.0 / 3.0


class ByRecord(NamedTuple):
    """An explanation with numbers of its own in each record.

    ``accuracy``: of the fits together; ``fits``: to each record, after its name.
    """

    effects: tuple[str, ...]
    accuracy: float
    fits: tuple[tuple[str, Fit], ...]


def record_by_record(search: Search, level: Level) -> tuple[ByRecord, ...]:
    """The leading explanations of a level by themselves in each record, the most accurate first.

    None where that explains the records hardly better, or where there is one record.
    """
    records = search.data.tests_of_records
    if len(records) < 2:
        return ()
    found = search.each(lambda each: _of_records(each, records), level.rated[:COMPARED])
    found = sorted(found, key=lambda each: each.accuracy)
    return tuple(found) if found[0].accuracy < LEFT * level.best.accuracy else ()


def _of_records(rated: Rated, records: Sequence[tuple[str, np.ndarray]]) -> ByRecord:
    fits = [(name, accuracy.refined(subset_fit(rated.fit, rows)).fit) for name, rows in records]
    together = [(fit.model.data, fit.evaluation) for _, fit in fits]
    dof = sum(fit.dof for _, fit in fits)
    return ByRecord(rated.effects, accuracy.of_responses(together, dof), tuple(fits))
