"""Noise from tests that were run more than once: what does not repeat.

Repeats never start alike. Each is compared with the mean of the others as it would be a little larger, a
little later, and with another zero and drift; what is left is noise.
"""

from collections.abc import Sequence

import numpy as np

from wedgesweep.measured import TestRecord

# By how much a repeat may begin earlier or later, as a share of its length.
SHIFT = 0.02


def groups(tests: Sequence[TestRecord]) -> list[list[int]]:
    """Indices of tests that repeat one another, for each test that was repeated."""
    by_file: dict[str, list[int]] = {}
    for place, test in enumerate(tests):
        by_file.setdefault(test.repeat_of or test.file, []).append(place)
    return [rows for rows in by_file.values() if len(rows) > 1]


def differences(records: Sequence[np.ndarray]) -> list[np.ndarray]:
    """What the others do not explain of each record (n,), with the variance of its own noise alone."""
    size = min(each.size for each in records)
    cut = np.array([each[:size] for each in records])
    share = 1.0 + 1.0 / (len(records) - 1)
    return [_left(cut[i], np.delete(cut, i, axis=0)) / np.sqrt(share) for i in range(len(records))]


def _left(record: np.ndarray, others: np.ndarray) -> np.ndarray:
    """What is left of a record (n,) beside the mean of others (m, n), each moved to where it fits."""
    mean = np.mean([_moved(each, _delay(record, each)) for each in others], axis=0)
    place = np.linspace(-1.0, 1.0, record.size)
    columns = np.column_stack([mean, np.gradient(mean), mean * place, np.ones(record.size), place])
    columns /= np.maximum(np.abs(columns).max(axis=0), 1e-300)
    return record - columns @ np.linalg.lstsq(columns, record, rcond=None)[0]


def _delay(one: np.ndarray, other: np.ndarray) -> int:
    """Samples by which one record lags behind another, within SHIFT."""
    most = int(SHIFT * one.size)
    lags = np.arange(-most, most + 1)
    inner = slice(most, one.size - most)
    overlap = [float(one[inner] @ other[most - lag : one.size - most - lag]) for lag in lags]
    return int(lags[int(np.argmax(overlap))])


def _moved(record: np.ndarray, lag: int) -> np.ndarray:
    """A record (n,) that begins a number of samples later; its ends are repeated."""
    places = np.clip(np.arange(record.size) - lag, 0, record.size - 1)
    return record[places]
