"""Noise from tests that were run more than once: what does not repeat.

Repeats never start alike. The mean of the others is fitted to each, a little larger, a little later, and with
another zero and drift; the residual is noise.
"""

from collections.abc import Sequence

import numpy as np

from wedgesweep.measured import TestRecord

# Largest delay between repeats, as a share of their length.
SHIFT = 0.02


def groups(tests: Sequence[TestRecord]) -> list[list[int]]:
    """Indices of the tests of each group that repeat one another."""
    by_file: dict[str, list[int]] = {}
    for place, test in enumerate(tests):
        by_file.setdefault(test.repeat_of or test.file, []).append(place)
    return [rows for rows in by_file.values() if len(rows) > 1]


def differences(records: Sequence[np.ndarray]) -> list[np.ndarray]:
    """What the others do not explain of each record (n,), scaled to the variance of its own noise.

    All are cut to the length of the shortest.
    """
    size = min(each.size for each in records)
    cut = np.array([each[:size] for each in records])
    # The mean of the others has noise as well.
    variance = 1.0 + 1.0 / (len(records) - 1)
    return [_residual(cut[i], np.delete(cut, i, axis=0)) / np.sqrt(variance) for i in range(len(records))]


def _residual(record: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Residual (n,) of a record after a fit of the mean of others (m, n), each delayed to where it fits."""
    mean = np.mean([_delayed(each, _delay(record, each)) for each in others], axis=0)
    place = np.linspace(-1.0, 1.0, record.size)
    columns = np.column_stack([mean, np.gradient(mean), mean * place, np.ones(record.size), place])
    columns /= np.maximum(np.abs(columns).max(axis=0), 1e-300)
    return record - columns @ np.linalg.lstsq(columns, record, rcond=None)[0]


def _delay(one: np.ndarray, other: np.ndarray) -> int:
    """Samples by which one record lags behind another, within SHIFT."""
    longest = int(SHIFT * one.size)
    return longest - int(np.correlate(other, one[longest : one.size - longest], "valid").argmax())


def _delayed(record: np.ndarray, lag: int) -> np.ndarray:
    """A record (n,) that begins a number of samples later; its ends are repeated."""
    places = np.clip(np.arange(record.size) - lag, 0, record.size - 1)
    return record[places]
