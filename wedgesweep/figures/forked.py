"""Drawing on several processors at once."""

import multiprocessing
from collections.abc import Callable, Iterable
from typing import TypeVar

import joblib

Item = TypeVar("Item")
Result = TypeVar("Result")


def each(function: Callable[[Item], Result], items: Iterable[Item], n_jobs: int) -> list[Result]:
    """Results of a function of every item, in their order.

    matplotlib keeps the interpreter to itself, so that it takes processes: forks of this one, which have
    loaded all that it has. Where there are none, new ones would take longer to start than to draw.
    """
    forked = multiprocessing.get_start_method() == "fork"
    pool = joblib.Parallel(n_jobs if forked else 1, backend="multiprocessing", batch_size=1)
    return pool(joblib.delayed(function)(item) for item in items)
