"""Backends: cases run in threads or processes of this machine; ``cluster`` adds a Dask cluster.

Each backend provides a joblib.Parallel.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor
from contextlib import AbstractContextManager, contextmanager
from typing import Any, Protocol

import joblib

from wedgesweep.errors import SweepError


class Backend(Protocol):
    """Opens a pool of ``n_jobs`` workers; ``fingerprint()`` shows whether a worker runs the same code."""

    def __call__(
        self, n_jobs: int, fingerprint: Callable[[], dict[str, str]]
    ) -> AbstractContextManager[joblib.Parallel]: ...


def parallel(**options: Any) -> joblib.Parallel:
    """Return a joblib.Parallel that yields results as they finish."""
    # Chunks are batches already.
    return joblib.Parallel(return_as="generator_unordered", batch_size=1, **options)


@contextmanager
def threads(n_jobs: int, fingerprint: Callable[[], dict[str, str]]) -> Iterator[joblib.Parallel]:
    """Threads of this process: start at once, and suit compiled solvers, which release the GIL."""
    yield parallel(n_jobs=n_jobs, backend="threading")


@contextmanager
def loky(n_jobs: int, fingerprint: Callable[[], dict[str, str]]) -> Iterator[joblib.Parallel]:
    """Processes of this machine."""
    try:
        yield parallel(n_jobs=n_jobs)
    except BrokenExecutor as error:
        message = "a job died, killed or out of memory; rerun the same command to resume"
        raise SweepError(message) from error


def count_jobs(n_jobs: int | None) -> int:
    """Return the number of jobs: as given, or one for each processor that this process may use."""
    return n_jobs or joblib.cpu_count()


def local(method: str) -> Backend:
    """Return the backend of this machine that suits a solver."""
    return threads if method == "event-driven" else loky
