"""Sweeps up and down in beta: each case starts from the steady state of its neighbour.

Which of several coexisting responses is found depends on the initial state. A line holds the cases of one
law and one amplitude over all frequencies. It is run up and then down in beta: the sweep up starts from rest,
the sweep down from the end of the sweep up. Each case starts from the state of the one before at phase 0 of
the input, or from rest if that case failed.
"""

from collections.abc import Iterator

import numpy as np

from wedgesweep.simulate import Settings
from wedgesweep.sweep import variables
from wedgesweep.sweep.batch import solve_batch

COEXISTING, ALONE, NOT_TOLD = 1, 0, -1


def solve_lines(cases: np.ndarray, indices: np.ndarray, settings: Settings, dtype: np.dtype) -> np.ndarray:
    """Solve whole lines, given in any order, up and down in beta.

    ``cases`` are parameter records, shape (n,). Lines do not depend on each other. The records returned are
    those of the sweep up; their variables ``variables.CONTINUED`` describe the sweep down.
    """
    records = variables.blank(dtype, indices)
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
    """Yield the indices of the cases of each law and amplitude, sorted by frequency."""
    given, law = cases["input"], cases["friction"]["law"]
    order = np.lexsort((given["omega"], given["amplitude"], law))
    ends = (np.diff(law[order]) != 0) | (np.diff(given["amplitude"][order]) != 0.0)
    yield from np.split(order, np.flatnonzero(ends) + 1)


def there_and_back(line: np.ndarray) -> np.ndarray:
    """Return the indices of a line swept up and down, shape (2 n,)."""
    return np.concatenate([line, line[::-1]])


def compared(records: np.ndarray, steady_tolerance: float) -> np.ndarray:
    """Flag whether both sweeps end in different responses, shape (n,); -1 if one of them is not periodic."""
    apart = np.abs(records["amplitude_ratio"] - records["amplitude_ratio_down"])
    differ = (apart > variables.DISTINCT * steady_tolerance) | (records["period"] != records["period_down"])
    told = (records["period"] > 0) & (records["period_down"] > 0)
    return np.where(told, np.where(differ, COEXISTING, ALONE), NOT_TOLD)
