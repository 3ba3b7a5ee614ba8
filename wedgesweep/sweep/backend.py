"""Where cases are solved: in threads or processes of this machine; ``cluster`` adds a Dask cluster.

Each gives a joblib.Parallel, so that results come out of all of them in one way.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor
from contextlib import AbstractContextManager, contextmanager
from typing import Any, Protocol

import joblib

from wedgesweep.errors import SweepError


class Backend(Protocol):
    """Opens a pool for ``run`` chunks at a time; ``fingerprint()`` tells what a worker would compute."""

    def __call__(
        self, n_jobs: int, fingerprint: Callable[[], dict[str, str]]
    ) -> AbstractContextManager[joblib.Parallel]: ...


def parallel(**options: Any) -> joblib.Parallel:
    """A joblib.Parallel whose results come as they are ready."""
    # Cases that go together are together already: joblib need not batch them again.
    return joblib.Parallel(return_as="generator_unordered", batch_size=1, **options)


@contextmanager
def threads(n_jobs: int, fingerprint: Callable[[], dict[str, str]]) -> Iterator[joblib.Parallel]:
    """Threads of this process, for solvers that are compiled as a whole: they start at once."""
    yield parallel(n_jobs=n_jobs, backend="threading")


@contextmanager
def loky(n_jobs: int, fingerprint: Callable[[], dict[str, str]]) -> Iterator[joblib.Parallel]:
    """Processes of this machine; they run this very code."""
    try:
        yield parallel(n_jobs=n_jobs)
    except BrokenExecutor as error:
        message = "a job died, killed or out of memory; rerun the same command to resume"
        raise SweepError(message) from error


def count_jobs(n_jobs: int | None) -> int:
    """Number of jobs: as given, or one for each processor that this process may use."""
    return n_jobs or joblib.cpu_count()


def local(method: str) -> Backend:
    """The backend of this machine that suits a solver."""
    return threads if method == "event-driven" else loky
