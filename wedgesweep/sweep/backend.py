"""Backends: cases run in threads or processes of this machine; ``cluster`` adds a Dask cluster."""

import os
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import BrokenExecutor
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import joblib
import numpy as np

from wedgesweep import plugins
from wedgesweep.errors import SweepError
from wedgesweep.processes import end_with, interrupts_ignored

# Number of tasks per worker that are sent out at a time.
SENT_AHEAD = 2


class Solve(Protocol):
    """Yields ``task(item)`` for each item, in the order in which they finish."""

    def __call__(self, task: Callable[[Any], Any], items: Iterable[Any]) -> Generator[Any, None, None]: ...


@dataclass(frozen=True)
class Pool:
    """Workers: ``solve`` raises one of the errors ``lost`` if a worker dies; it can be called again."""

    solve: Solve
    n_jobs: int
    lost: tuple[type[BaseException], ...] = ()


class Backend(Protocol):
    """Opens a pool of ``n_jobs`` workers; ``fingerprint()`` shows whether a worker runs the same code."""

    def __call__(
        self, n_jobs: int, fingerprint: Callable[[], dict[str, str]]
    ) -> AbstractContextManager[Pool]: ...


@contextmanager
def threads(n_jobs: int, fingerprint: Callable[[], dict[str, str]]) -> Iterator[Pool]:
    """Threads of this process: start at once, and suit compiled solvers, which release the GIL."""
    yield Pool(_joblib(n_jobs=n_jobs, backend="threading"), n_jobs)


@contextmanager
def loky(n_jobs: int, fingerprint: Callable[[], dict[str, str]]) -> Iterator[Pool]:
    """Processes of this machine."""
    yield Pool(_joblib(**_processes(n_jobs)), n_jobs, (BrokenExecutor,))


def in_order(tasks: Iterable[Any], n_jobs: int) -> list[Any]:
    """Results of tasks (joblib.delayed) in processes of this machine; raises SweepError if one dies."""
    try:
        return joblib.Parallel(**_processes(n_jobs))(tasks)
    except BrokenExecutor as error:
        raise SweepError(
            "a job died, killed or out of memory; run the same command again, with fewer --n-jobs"
        ) from error


def _processes(n_jobs: int) -> dict[str, Any]:
    """Options of joblib for processes that end with this one also if it is killed, and know its plug-ins."""
    begun = {"initializer": _begin, "initargs": (os.getpid(), plugins.loaded())}
    return {"n_jobs": n_jobs, "backend": "loky", **begun}


def _begin(parent: int, files: tuple[Path, ...]) -> None:
    end_with(parent)
    plugins.load_all(files)


def _joblib(**options: Any) -> Solve:
    def solve(task: Callable[[Any], Any], items: Iterable[Any]) -> Generator[Any, None, None]:
        # The items are chunks, which are batches already.
        ahead = f"{SENT_AHEAD} * n_jobs"
        unordered = {"return_as": "generator_unordered", "batch_size": 1, "pre_dispatch": ahead}
        with interrupts_ignored():
            results = joblib.Parallel(**unordered, **options)(joblib.delayed(task)(item) for item in items)
        try:
            # "yield from" would close the results outside of the filter below.
            for result in results:  # noqa: UP028
                yield result
        finally:
            with warnings.catch_warnings():
                # joblib warns when a run is stopped early.
                warnings.simplefilter("ignore", UserWarning)
                results.close()

    return solve


def count_jobs(n_jobs: int | None) -> int:
    """Return the number of jobs: as given, or one for each processor that this process may use.

    Raises SweepError if it is no whole number of at least 1.
    """
    if n_jobs is None:
        return joblib.cpu_count()
    if isinstance(n_jobs, bool) or not isinstance(n_jobs, int | np.integer) or n_jobs < 1:
        raise SweepError(
            f"n_jobs: {n_jobs!r} is no number of jobs; write 1 or more, or None for one per processor"
        )
    return int(n_jobs)


def local(method: str) -> Backend:
    """Return the backend of this machine that suits a solver."""
    return threads if method == "event-driven" else loky
