"""A sweep that grows: cases of an earlier run that it has, too, known by all their numbers in full precision.

A case is the same if its parameter record is, bit for bit (in a continuation: those of its whole row), and
if both sweeps have the same solver, input and code.
"""

from collections.abc import Iterator
from hashlib import blake2b

import numpy as np
import xarray as xr

from wedgesweep.config import Config
from wedgesweep.sweep import variables
from wedgesweep.sweep.chunks import Rows

AT_A_TIME = 10_000


def carried(records: np.ndarray, earlier: tuple[Config, Rows], now: tuple[Config, Rows]) -> np.ndarray:
    """Records of an earlier sweep with the indices that their cases have now; the others are dropped."""
    if _context(earlier[0]) != _context(now[0]):
        return records[:0]
    place = dict(zip(_keys(*earlier, records["index"]), range(len(records)), strict=True))
    config, rows = now
    found = [
        (place[key], index)
        for index, key in enumerate(_keys(config, rows, np.arange(config.sweep.count)))
        if key in place
    ]
    places, indices = np.array(found, int).reshape(-1, 2).T
    kept = records[places]
    kept["index"] = indices
    return kept


def _context(config: Config) -> tuple[object, ...]:
    """What results depend on beside parameter records."""
    own = (config.document["solver"], config.system)
    # The inputs themselves are part of the keys.
    transient = config.solver.transient
    return own if transient is None else (*own, config.omega_n, transient.samples)


def _keys(config: Config, rows: Rows, indices: np.ndarray) -> Iterator[bytes]:
    """A digest of all numbers of each case: those of its row, and its place there."""
    for first in range(0, len(indices), AT_A_TIME):
        some = indices[first : first + AT_A_TIME]
        different, numbers = np.unique(rows.of(some), return_inverse=True)
        cases = rows.cases(different)
        records = config.records(cases.ravel()).reshape(cases.shape)
        rest = _inputs(config, cases)
        digests = [
            blake2b(row.tobytes() + text, digest_size=16).digest()
            for row, text in zip(records, rest, strict=True)
        ]
        places = some // rows.stride % rows.width
        for number, place in zip(numbers.tolist(), places.tolist(), strict=True):
            yield digests[number] + place.to_bytes(4)


def _inputs(config: Config, cases: np.ndarray) -> list[bytes]:
    """The table [input] of the first case of each row; nothing where the input is a sine."""
    if not config.transient:
        return [b""] * len(cases)
    return [repr(sorted(table.items())).encode() for table in config.tables_of_input(cases[:, 0])]


def records_of(ds: xr.Dataset, dtype: np.dtype) -> np.ndarray:
    """The records from which a dataset was assembled."""
    count = ds["status"].size
    records = variables.blank(dtype, np.arange(count))
    for name in set(dtype.names or ()) & set(ds.data_vars):
        values = ds[name].values.reshape(count, *dtype[name].shape)
        records[name] = [text.encode() for text in values.tolist()] if values.dtype.kind in "OUT" else values
    return records
