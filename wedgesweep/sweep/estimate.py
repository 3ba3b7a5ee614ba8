"""Estimate of the time and memory that a sweep needs, from a timed sample of its cases."""

import resource
import sys
from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np

from wedgesweep.simulate import Transient
from wedgesweep.sweep import variables
from wedgesweep.sweep.backend import local
from wedgesweep.sweep.backend import threads as in_threads
from wedgesweep.sweep.cases import compile_once, short_run, solve_cases
from wedgesweep.sweep.run import Sweep

MOST_CASES = 60
SECONDS = 0.3
# Samples of the shortest start of a motion that is timed, and how many times as long the next one is.
FIRST_SAMPLES, LONGER = 2, 10
# A Radau run of a given number of periods is timed over the share 1/PART of them, as all take about as long.
PART = 4
GOLDEN = 0.6180339887498949


@dataclass(frozen=True)
class Estimate:
    """Cost of all cases of a sweep; ``sampled`` holds the records of the cases that were timed.

    ``memory`` (bytes) is that of all processes, of which each case adds ``bytes_per_case``.
    """

    sampled: np.ndarray
    seconds: float
    memory: float
    bytes_per_case: int
    dataset_bytes: int


def estimate(sweep: Sweep, n_jobs: int) -> Estimate:
    """Time a few cases spread over the sweep, for a moment, and extrapolate to ``n_jobs`` jobs."""
    compile_once(sweep.settings, sweep.kit, sweep.config.system)
    _load(sweep)
    started = perf_counter()
    records = []
    for index in _spread(sweep.count):
        records.append(_timed(sweep, np.array([index])))
        if perf_counter() - started > SECONDS:
            break
    sampled = np.concatenate(records)
    threads = local(sweep.settings.method) is in_threads
    processes = 1 if threads else n_jobs + 1
    # The records of all cases, and at the end a copy of one variable after the other.
    largest = max(sweep.dtype[name].itemsize for name in sweep.dtype.names or ())
    each = sweep.dtype.itemsize + largest
    return Estimate(
        sampled,
        float(sampled["wall_time"].mean() * sweep.count) / n_jobs,
        processes * _peak_memory() + sweep.count * each,
        each,
        sweep.count * sweep.dtype.itemsize,
    )


def _load(sweep: Sweep) -> None:
    """Have the compiled code loaded, by a case that is as short as can be."""
    first, (short, dtype) = np.array([0]), short_run(sweep.settings)
    solve_cases(sweep.config.records(first), first, short, short.case_timeout, dtype)


def _timed(sweep: Sweep, index: np.ndarray) -> np.ndarray:
    """Record of a case, shape (1,), with the wall time (s) of all its periods; Radau runs a part of them."""
    settings, records = sweep.settings, sweep.config.records(index)
    if settings.transient is not None:
        (own,) = sweep.config.transients(index) or (settings.transient,)
        return _timed_motion(sweep, index, own)
    if settings.method != "radau" or settings.steady or settings.continuation:
        return sweep.solve(index)
    periods = int(settings.settling(records["input"]["omega"])[0]) + settings.kept_periods
    settle = max(periods // PART - settings.kept_periods, 1)
    short = replace(settings, duration=None, settle_periods=settle)
    found = solve_cases(records, index, short, short.case_timeout, sweep.dtype)
    found["wall_time"] *= periods / (settle + settings.kept_periods)
    return found


def _timed_motion(sweep: Sweep, index: np.ndarray, whole: Transient) -> np.ndarray:
    """Record of a motion, shape (1,), with the wall time (s) of all of it; its start is run for a moment."""
    samples = min(FIRST_SAMPLES, whole.samples)
    found = _start_of_motion(sweep, index, whole, samples)
    while samples < whole.samples and found["wall_time"][0] * LONGER < SECONDS:
        samples = min(LONGER * samples, whole.samples)
        found = _start_of_motion(sweep, index, whole, samples)
    found["wall_time"] *= whole.samples / samples
    return found


def _start_of_motion(sweep: Sweep, index: np.ndarray, whole: Transient, samples: int) -> np.ndarray:
    """Record of the first samples of a motion, shape (1,), which are not stored."""
    short = replace(sweep.settings, transient=whole.first(samples))
    dtype = variables.record_dtype({"time": 0}, False)
    return solve_cases(sweep.config.records(index), index, short, short.case_timeout, dtype)


def _spread(count: int) -> list[int]:
    """Return up to MOST_CASES of ``count`` indices; any first few are spread over all (golden section)."""
    places = (0.5 + GOLDEN * np.arange(4 * MOST_CASES)) % 1.0
    return list(dict.fromkeys((places * count).astype(int).tolist()))[:MOST_CASES]


def _peak_memory() -> int:
    """Return the peak memory (bytes) of this process; a job needs about as much."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024
