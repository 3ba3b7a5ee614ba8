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
from wedgesweep.__main__ import GARBAGE, THREADS

ROOT = Path(__file__).parents[1]
# Folders whose tests compile most, and what the others need: one process runs them, from the beginning, and
# compiles each function once. The tests of LAST find it compiled.
MECHANICS, LAST = ("config", "physics", "sweep"), "diagnose"
KERNELS = ROOT / ".kernels"

# Threads of numpy's libraries stand in each other's way on a busy machine.
os.environ.update(dict.fromkeys(THREADS, "1"))
gc.set_threshold(GARBAGE)
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


def _folder(nodeid):
    return Path(nodeid).parts[1]


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """Give a process files in turn, and one of them all those of the mechanics."""
    from xdist.scheduler import LoadFileScheduling

    if config.option.dist != "loadfile":
        return None

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid):
            return "mechanics" if _folder(nodeid) in MECHANICS else super()._split_scope(nodeid)

    return Scheduling(config, log)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Of a test that is marked ``few(n)`` leave n sets of parameters to ``make test``, from all over them."""
    items.sort(key=lambda item: (_folder(item.nodeid) not in MECHANICS, _folder(item.nodeid) == LAST))
    sets = {}
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
