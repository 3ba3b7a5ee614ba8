"""Drawing on several processors at once."""

import gc
import multiprocessing
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def each(function: Callable[[Item], Result], items: Iterable[Item], n_jobs: int) -> list[Result]:
    """Results of a function of every item, in their order.

    matplotlib keeps the interpreter to itself, so that it takes processes: forks of this one, which have
    loaded all that it has. Where there are none, new ones would take longer to start than to draw.
    They leave their garbage: to look for it among all that was loaded takes a fifth of the time.
    """
    if n_jobs == 1 or multiprocessing.get_start_method() != "fork":
        return [function(item) for item in items]
    context = multiprocessing.get_context("fork")
    with ProcessPoolExecutor(n_jobs, context, initializer=gc.disable) as pool:
        return list(pool.map(function, items))
