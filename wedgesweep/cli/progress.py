"""Progress of a sweep on stderr: a bar on a terminal, log lines elsewhere."""

import sys
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from wedgesweep.cli.humanize import duration
from wedgesweep.cli.messages import log, shows_status
from wedgesweep.formatting import counted

if TYPE_CHECKING:
    import numpy as np

# Off a terminal there is a line for this share of the cases, but not more often than each so many seconds, or
# after so many.
LINE_SHARE = 0.1
LEAST_SECONDS, LINE_SECONDS = 1.0, 30.0


class ProgressReport:
    """A ``sweep.run.Progress`` that counts the cases of one sweep, or of several in turn."""

    def __init__(self) -> None:
        self.done = self.failed = self.kept = self.total = 0
        self._bar: Any = None
        self._started = self._said = 0.0
        self._said_done = 0

    def __call__(self, records: "np.ndarray", total: int) -> None:
        begins = self.done == self.total
        if begins:
            self.done = self.failed = 0
            self.total, self.kept = total, len(records)
        self.done += len(records)
        self.failed += int((records["status"] != 0).sum())
        if begins:
            self._begin()
        elif self._bar is not None:
            self._bar.update(len(records), self.failed)
        else:
            self._log()
        if self.done == self.total:
            self.stop()

    def stop(self) -> None:
        """Close the progress bar."""
        if self._bar is not None:
            self._bar.render_finish()
            self._bar = None

    def _begin(self) -> None:
        self._started = self._said = perf_counter()
        self._said_done = self.done
        kept = f", {self.kept} of them from an earlier run" if self.kept else ""
        log.info(f"{counted(self.total, 'case')}{kept}")
        if shows_status() and self.done < self.total:
            self._bar = click.progressbar(
                length=self.total - self.kept,
                show_pos=True,
                item_show_func=lambda failed: f"{failed} failed" if failed else "",
                file=sys.stderr,
            )
            self._bar.render_progress()

    def _log(self) -> None:
        now = perf_counter()
        silent = now - self._said
        due = self.done - self._said_done >= LINE_SHARE * self.total and silent >= LEAST_SECONDS
        if due or silent >= LINE_SECONDS or self.done == self.total:
            self._said, self._said_done = now, self.done
            log.info(self._line(now - self._started))

    def _line(self, elapsed: float) -> str:
        left = elapsed / max(self.done - self.kept, 1) * (self.total - self.done)
        ahead = f", about {duration(left)} left" if left else ""
        failed = f", {self.failed} failed" if self.failed else ""
        cases = "case" if self.total == 1 else "cases"
        return f"{self.done}/{self.total} {cases}{failed}, {duration(elapsed)}{ahead}"
