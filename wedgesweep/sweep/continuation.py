"""Sweeps up and down in beta: each case starts from the steady state of its neighbour.

A response that exists beside another one is found by where it came from. A line holds the cases of one law
and one amplitude over all frequencies, up and down again in one chain: the way up starts from rest, the way
down where the way up ended. The state at phase 0 of the input is handed on as it is; behind a case that
failed comes rest.
"""

from collections.abc import Iterator

import numpy as np

from wedgesweep.simulate import Settings
from wedgesweep.sweep import dataset
from wedgesweep.sweep.batch import solve_batch

COEXISTING, ALONE, NOT_TOLD = 1, 0, -1


def solve_lines(cases: np.ndarray, indices: np.ndarray, settings: Settings, dtype: np.dtype) -> np.ndarray:
    """Records of whole lines, in any order: the way up, with the way down as ``dataset.CONTINUED``.

    ``cases`` are parameter records, shape (n,). The lines do not depend on each other.
    """
    records = dataset.blank(dtype, indices)
    for line in lines(cases):
        both = there_and_back(line)
        found, _ = solve_batch(cases[both], indices[both], settings, dtype, continuation=True)
        up, down = found[: line.size], found[line.size :][::-1]
        up["amplitude_ratio_down"], up["period_down"] = down["amplitude_ratio"], down["period"]
        up["coexisting"] = compared(up, settings.steady_tolerance)
        up["wall_time"] += down["wall_time"]
        records[line] = up
    return records


def lines(cases: np.ndarray) -> Iterator[np.ndarray]:
    """Places of the cases of each law and amplitude, by frequency."""
    given, law = cases["input"], cases["friction"]["law"]
    order = np.lexsort((given["omega"], given["amplitude"], law))
    ends = (np.diff(law[order]) != 0) | (np.diff(given["amplitude"][order]) != 0.0)
    yield from np.split(order, np.flatnonzero(ends) + 1)


def there_and_back(line: np.ndarray) -> np.ndarray:
    """Places (2 n,) of a line on its way up and down."""
    return np.concatenate([line, line[::-1]])


def compared(records: np.ndarray, steady_tolerance: float) -> np.ndarray:
    """Whether both ways lead to different responses, as the flag of the dataset; shape (n,).

    Without a periodic answer on both ways there is nothing to compare.
    """
    apart = np.abs(records["amplitude_ratio"] - records["amplitude_ratio_down"])
    differ = (apart > dataset.DISTINCT * steady_tolerance) | (records["period"] != records["period_down"])
    told = (records["period"] > 0) & (records["period_down"] > 0)
    return np.where(told, np.where(differ, COEXISTING, ALONE), NOT_TOLD)
