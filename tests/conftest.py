"""Tests run as the command does, and share one cache of compiled code, which stays in the checkout."""

import fcntl
import gc
import os
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from wedgesweep import figures
from wedgesweep.__main__ import THREADS

ROOT = Path(__file__).parents[1]
# Long files that compile nothing, for the time in which sweep/test_axes.py compiles what most others need.
FIRST = (Path(__file__).with_name("test_figures.py"), Path(__file__).with_name("test_report.py"))
KERNELS = ROOT / ".kernels"

# Threads of numpy's libraries stand in each other's way on a busy machine.
os.environ.update(dict.fromkeys(THREADS, "1"))
# As the command does, for the same reason.
gc.set_threshold(100_000)
# Pictures are looked at by nobody here.
figures.DOTS_PER_INCH = 40
# Before wedgesweep.compiled is imported, which reads it. Its folders in there are named for the sources.
os.environ["WEDGESWEEP_CACHE_DIR"] = str(KERNELS)


def _compile_once() -> None:
    """Let one process of the tests compile a function while the others wait for it.

    A process that needs what another one is compiling would otherwise compile it as well.
    """
    from numba.core.ccallback import CFunc
    from numba.core.compiler_lock import global_compiler_lock
    from numba.core.dispatcher import Dispatcher

    from wedgesweep.kernels import KernelCache

    def waiting(compile_here, function_of):
        def compile_or_wait(self, *signature):
            function = function_of(self)
            if not isinstance(self._cache, KernelCache):
                return compile_here(self, *signature)
            # A period map is compiled once for each kind of records, which its closure holds.
            held = [cell.cell_contents for cell in function.__closure__ or ()]
            kinds = [each for each in held if isinstance(each, np.dtype)]
            name = f"{function.__module__}.{function.__qualname__} {signature or self._sig} {kinds}"
            path = KERNELS / f"{sha256(name.encode()).hexdigest()[:16]}.lock"
            with global_compiler_lock, path.open("w") as lock:
                fcntl.flock(lock, fcntl.LOCK_EX)
                return compile_here(self, *signature)

        return compile_or_wait

    Dispatcher.compile = waiting(Dispatcher.compile, lambda each: each.py_func)
    CFunc.compile = waiting(CFunc.compile, lambda each: each._pyfunc)


with suppress(OSError):  # a checkout that cannot be written to
    KERNELS.mkdir(exist_ok=True)
    _compile_once()


@pytest.fixture
def empty_pictures(monkeypatch):
    """Pictures are empty files: to write them takes longest, and is tested where they are drawn."""
    monkeypatch.setattr(figures, "save", lambda figure, path: Path(path).touch())


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Of a test that is marked ``few(n)`` leave n sets of parameters to ``make test``, from all over them.

    Both processes of ``make test`` get files in turn: neighbours are from different folders, so that they do
    not wait for each other to compile the same code.
    """
    folders, sets = {FIRST[0].parent: [*FIRST]}, {}
    for item in items:
        files = folders.setdefault(item.path.parent, [])
        files += [] if item.path in files else [item.path]
    items.sort(key=lambda item: 0 if item.path in FIRST else folders[item.path.parent].index(item.path))
    for item in items:
        if item.get_closest_marker("few"):
            sets.setdefault((item.path, item.originalname), []).append(item)
    for some in sets.values():
        number = some[0].get_closest_marker("few").args[0]
        size = max(len(some) // number, 1)
        # One of each block of neighbours, not always in the same place: the last parameter varies fastest.
        chosen = {block * size + block % size for block in range(number)}
        for place, item in enumerate(some):
            if place not in chosen:
                item.add_marker("acceptance")


def pytest_collection_finish():
    """Let the collector of garbage pass over what was imported, which it would look through in every test."""
    gc.collect()
    gc.freeze()
