"""Processes that must not outlive the one that started them, and work that may end its process."""

import multiprocessing
import os
import signal
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection
from typing import Any

KILL = getattr(signal, "SIGKILL", signal.SIGTERM)  # Windows has the latter only
# Signals that a terminal sends to all processes of a command; Windows has no SIGHUP.
OF_THE_TERMINAL = tuple(getattr(signal, name) for name in ("SIGINT", "SIGHUP") if hasattr(signal, name))
# Processor time (s), and time (s) in all, that a library may take to read a file.
MOST_WORK, MOST_WAIT = 30, 600.0
# Time (s) between two looks at the parent.
INTERVAL = 1.0


def end_with(parent: int) -> None:
    """Let this process end soon after its parent, a process id, however that has ended."""
    threading.Thread(target=_watch, args=(parent,), daemon=True).start()


@contextmanager
def interrupts_ignored() -> Iterator[None]:
    """Let jobs that start meanwhile ignore ctrl-C and the end of the terminal; this process ends them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, signal.SIG_IGN) for number in OF_THE_TERMINAL}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def apart(function: Callable[..., Any], *arguments: Any) -> Any:
    """Call a function in a fork of this process; raises OSError if that dies of it or finds no end.

    Libraries that read damaged files may end the process they run in, or turn in circles. Where processes
    cannot fork, the function is called here.
    """
    if not hasattr(os, "fork"):
        return function(*arguments)
    context = multiprocessing.get_context("fork")
    receiving, sending = context.Pipe(duplex=False)
    with warnings.catch_warnings():
        # Python warns of forks beside threads; this one takes no lock and starts none.
        warnings.simplefilter("ignore", DeprecationWarning)
        process = context.Process(target=_answer, args=(sending, function, arguments))
        process.start()
    sending.close()
    try:
        if not receiving.poll(MOST_WAIT):
            raise EOFError
        found = receiving.recv()
    except EOFError as error:
        raise OSError("damaged: the library that reads it gave up, or found no end") from error
    finally:
        process.kill()
        process.join()
    if isinstance(found, Exception):
        raise found
    return found


def _answer(sending: Connection, function: Callable[..., Any], arguments: tuple) -> None:
    with suppress(ImportError, ValueError):  # Windows has no limits, and one may be lower already
        import resource

        resource.setrlimit(resource.RLIMIT_CPU, (MOST_WORK, MOST_WORK + 1))
    try:
        found = function(*arguments)
    except Exception as error:  # goes to the process that asked
        found = error
    sending.send(found)


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(INTERVAL)
    os.kill(os.getpid(), KILL)
