"""A task that kills its worker; a module of few imports, as every new worker loads it."""

import os
import signal
from pathlib import Path
from typing import NamedTuple

import numpy as np

DTYPE = np.dtype([("index", "i8"), ("status", "i1"), ("message", "S99")])


class Task(NamedTuple):
    """Cases of a chunk."""

    indices: np.ndarray
    dtype: np.dtype = DTYPE


def deadly(task: Task, wrong: list[int], once: Path | None = None) -> np.ndarray:
    """Die with some cases; ``once``: a file, which stops that when it is there."""
    if np.isin(wrong, task.indices).any() and not (once and once.exists()):
        if once:
            once.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    records = np.zeros(len(task.indices), task.dtype)
    records["index"] = task.indices
    return records
