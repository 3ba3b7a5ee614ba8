"""Drawing on several processors at once."""

import gc
import multiprocessing
import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from typing import TypeVar

import matplotlib.figure  # noqa: F401 - the forks have what is loaded here

from wedgesweep.processes import end_with

Item = TypeVar("Item")
Result = TypeVar("Result")


def map_forked(function: Callable[[Item], Result], items: Iterable[Item], n_jobs: int) -> list[Result]:
    """Apply a function to every item; return the results in the order of the items.

    matplotlib holds the interpreter's lock, so processes draw: forks of this one, which have its modules
    already. Where processes cannot fork, one draws all: to start new ones would take longer. The forks do not
    collect garbage, as to search all that was loaded would take a fifth of the time.
    """
    if n_jobs == 1 or multiprocessing.get_start_method() != "fork":
        return [function(item) for item in items]
    context = multiprocessing.get_context("fork")
    with ProcessPoolExecutor(n_jobs, context, initializer=_prepare, initargs=(os.getpid(),)) as pool:
        return list(pool.map(function, items))


def _prepare(parent: int) -> None:
    gc.disable()
    end_with(parent)
