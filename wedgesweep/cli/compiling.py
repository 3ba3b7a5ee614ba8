"""Announces compilation whenever numba has to compile, which may take a minute."""

from time import perf_counter
from typing import Any

from wedgesweep.cli.messages import log
from wedgesweep.formatting import duration

# Time (s) of compilation before the first message, and between later ones.
FIRST_AFTER, REPEATED_AFTER = 1.0, 15.0
FIRST = "compiling the solver (once: 15 s of CPU time, for a diagnosis half a minute)"

_listener: Any = None


def announce_compiling() -> None:
    """From now on, announce compilation in this process."""
    global _listener
    if _listener is None:
        from numba.core import event

        from wedgesweep import kernels

        if place := kernels.unwritable():
            kept = kernels.folder() or "nowhere"
            log.info("%s cannot be written to: compiled code is kept in %s", place, kept)
        _listener = listener(event.Listener)
        event.register("numba:compile", _listener)


def seconds_compiling() -> float:
    """How long (s) this process has compiled by now; 0 where it is not announced."""
    return _listener.elapsed() if _listener is not None else 0.0


def listener(base: type) -> Any:
    """Make a listener that numba calls when it begins and ends compiling a function; functions nest."""

    class Listener(base):
        def __init__(self) -> None:
            self.depth, self.began, self.before, self.due = 0, 0.0, 0.0, FIRST_AFTER

        def on_start(self, event: Any) -> None:
            if self.depth == 0:
                self.began = perf_counter()
            self.depth += 1
            self._announce()

        def on_end(self, event: Any) -> None:
            if self.depth == 1:
                self.before = self.elapsed()
            self.depth -= 1
            self._announce()

        def elapsed(self) -> float:
            return self.before + (perf_counter() - self.began if self.depth else 0.0)

        def _announce(self) -> None:
            elapsed = self.elapsed()
            if elapsed > self.due:
                log.info(FIRST if self.due == FIRST_AFTER else f"compiling, {duration(elapsed)} so far")
                self.due = elapsed + REPEATED_AFTER

    return Listener()
