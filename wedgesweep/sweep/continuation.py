"""Sweeps up and down in beta: each case starts from the steady state of its neighbour.

Which of several coexisting responses is found depends on the initial state. A row holds the cases of one law,
model and amplitude at all frequencies. It is run up and then down in beta: the sweep up starts from rest, the
sweep down from the end of the sweep up. Each case starts from the state of the one before it at phase 0 of
the input, or from rest if that case failed.
"""

from collections.abc import Iterator

import numpy as np

from wedgesweep.simulate import Settings
from wedgesweep.sweep import variables
from wedgesweep.sweep.batch import solve_batch

COEXISTING, ALONE, NOT_TOLD = 1, 0, -1


def solve_rows(cases: np.ndarray, indices: np.ndarray, settings: Settings, dtype: np.dtype) -> np.ndarray:
    """Solve whole rows, given in any order, up and down in beta.

    ``cases`` are parameter records, shape (n,). Rows do not depend on each other. The records returned are
    those of the sweep up; their variables ``variables.CONTINUED`` describe the sweep down.
    """
    records = variables.blank(dtype, indices)
    for row in _rows(cases):
        both = up_and_down(row)
        found, _ = solve_batch(cases[both], indices[both], settings, dtype, continuation=True)
        up, down = found[: row.size], found[row.size :][::-1]
        up["amplitude_ratio_down"], up["period_down"] = down["amplitude_ratio"], down["period"]
        up["coexisting"] = coexistence(up, settings.steady_tolerance)
        up["wall_time"] += down["wall_time"]
        records[row] = up
    return records


def _rows(cases: np.ndarray) -> Iterator[np.ndarray]:
    """Yield the indices of the cases that differ in frequency only, sorted by it."""
    rest = cases.copy()
    rows: dict[bytes, list[int]] = {}
    rest["input"]["omega"] = 0.0
    for place, record in enumerate(rest):
        rows.setdefault(record.tobytes(), []).append(place)
    for row in map(np.array, rows.values()):
        yield row[np.argsort(cases["input"]["omega"][row])]


def up_and_down(row: np.ndarray) -> np.ndarray:
    """Return the indices of a row swept up and down, shape (2 n,)."""
    return np.concatenate([row, row[::-1]])


def coexistence(records: np.ndarray, steady_tolerance: float) -> np.ndarray:
    """Flag whether both sweeps end in different responses, shape (n,); -1 if one of them is not periodic."""
    apart = np.abs(records["amplitude_ratio"] - records["amplitude_ratio_down"])
    differ = (apart > variables.DISTINCT * steady_tolerance) | (records["period"] != records["period_down"])
    told = (records["period"] > 0) & (records["period_down"] > 0)
    return np.where(told, np.where(differ, COEXISTING, ALONE), NOT_TOLD)
