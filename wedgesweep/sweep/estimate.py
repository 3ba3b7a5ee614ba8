"""Estimate of the time and memory that a sweep needs, from a timed sample of its cases."""

import resource
import sys
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from wedgesweep.sweep.cases import compile_once
from wedgesweep.sweep.run import Sweep

MOST_CASES = 60
SECONDS = 8.0
GOLDEN = 0.6180339887498949


@dataclass(frozen=True)
class Estimate:
    """Cost of all cases of a sweep; ``sampled`` holds the records of the cases that were timed."""

    sampled: np.ndarray
    seconds_on_one_job: float
    process_bytes: int
    dataset_bytes: int


def estimate(sweep: Sweep) -> Estimate:
    """Time a few cases spread over the sweep, for some seconds, and extrapolate."""
    cases = sweep.count
    compile_once(sweep.settings.method, sweep.kit, sweep.config.system)
    sweep.solve(np.array([0]))  # loads the compiled code
    started = perf_counter()
    records = []
    for index in _spread(cases):
        records.append(sweep.solve(np.array([index])))
        if perf_counter() - started > SECONDS:
            break
    sampled = np.concatenate(records)
    seconds = float(sampled["wall_time"].mean() * cases)
    return Estimate(sampled, seconds, _peak_memory(), cases * sweep.dtype.itemsize)


def _spread(count: int) -> list[int]:
    """Return up to MOST_CASES of ``count`` indices; any first few are spread over all (golden section)."""
    places = (0.5 + GOLDEN * np.arange(4 * MOST_CASES)) % 1.0
    return list(dict.fromkeys((places * count).astype(int).tolist()))[:MOST_CASES]


def _peak_memory() -> int:
    """Return the peak memory (bytes) of this process; a job needs about as much."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024
