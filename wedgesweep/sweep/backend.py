"""Backends: cases run in threads or processes of this machine; ``cluster`` adds a Dask cluster."""

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

import joblib
from joblib._parallel_backends import LokyBackend

from wedgesweep.errors import SweepError
from wedgesweep.processes import end_with

# Number of tasks per worker that are sent out at a time.
SENT_AHEAD = 2


@dataclass(frozen=True)
class Pool:
    """Workers: ``parallel()`` is a joblib.Parallel on those that are there now.

    The errors ``lost`` show that a worker has died; after one of them that joblib.Parallel cannot be used
    again.
    """

    parallel: Callable[[], joblib.Parallel]
    n_jobs: int
    lost: tuple[type[BaseException], ...] = ()


class Backend(Protocol):
    """Opens a pool of ``n_jobs`` workers; ``fingerprint()`` shows whether a worker runs the same code."""

    def __call__(
        self, n_jobs: int, fingerprint: Callable[[], dict[str, str]]
    ) -> AbstractContextManager[Pool]: ...


def parallel(**options: Any) -> joblib.Parallel:
    """Return a joblib.Parallel that yields results as they finish."""
    # Chunks are batches already.
    ahead = f"{SENT_AHEAD} * n_jobs"
    return joblib.Parallel(return_as="generator_unordered", batch_size=1, pre_dispatch=ahead, **options)


@contextmanager
def threads(n_jobs: int, fingerprint: Callable[[], dict[str, str]]) -> Iterator[Pool]:
    """Threads of this process: start at once, and suit compiled solvers, which release the GIL."""
    yield Pool(partial(parallel, n_jobs=n_jobs, backend="threading"), n_jobs)


class Loky(LokyBackend):
    """joblib's processes, which end with this one also if it is killed."""

    def configure(self, *arguments: Any, **options: Any) -> int:
        own = {"initializer": end_with, "initargs": (os.getpid(),)}
        return super().configure(*arguments, **own, **options)


@contextmanager
def loky(n_jobs: int, fingerprint: Callable[[], dict[str, str]]) -> Iterator[Pool]:
    """Processes of this machine."""
    yield Pool(lambda: parallel(n_jobs=n_jobs, backend=Loky()), n_jobs, (BrokenExecutor,))


def in_order(tasks: Iterable[Any], n_jobs: int) -> list[Any]:
    """Results of tasks (joblib.delayed) in processes of this machine; raises SweepError if one dies."""
    try:
        return joblib.Parallel(n_jobs=n_jobs, backend=Loky())(tasks)
    except BrokenExecutor as error:
        message = "a job died, killed or out of memory; run the same command again, with fewer --n-jobs"
        raise SweepError(message) from error


def count_jobs(n_jobs: int | None) -> int:
    """Return the number of jobs: as given, or one for each processor that this process may use."""
    return n_jobs or joblib.cpu_count()


def local(method: str) -> Backend:
    """Return the backend of this machine that suits a solver."""
    return threads if method == "event-driven" else loky
