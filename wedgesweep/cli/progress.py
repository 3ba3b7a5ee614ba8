"""Progress on stderr: a line that is written over on a terminal, log lines elsewhere."""

from time import perf_counter
from typing import TYPE_CHECKING

from wedgesweep.cli.compiling import seconds_compiling
from wedgesweep.cli.messages import log, show_status, shows_status
from wedgesweep.formatting import counted, duration

if TYPE_CHECKING:
    import numpy as np

# Off a terminal there is a line for this share of the whole, at least LEAST_SECONDS (s) after the last one,
# and in any case after LINE_SECONDS (s).
LINE_SHARE = 0.1
LEAST_SECONDS, LINE_SECONDS = 1.0, 30.0


class ProgressReport:
    """Counts the cases of sweeps or the steps of a diagnosis, and estimates the time for the rest."""

    def __init__(self) -> None:
        self.done = self.failed = self.kept = self.total = 0
        self._began = self._said = 0.0
        self._said_done = 0

    def cases(self, records: "np.ndarray", total: int) -> None:
        """Count finished cases of a sweep (a ``sweep.run.Progress``); several sweeps may follow in turn."""
        if self.done == self.total:
            kept = f", {len(records)} of them from an earlier run" if len(records) else ""
            log.info(f"{counted(total, 'case')}{kept}")
            self.failed = 0
            self._begin(len(records), total)
        else:
            self.done += len(records)
        self.failed += int((records["status"] != 0).sum())
        if self.done > self.kept:
            failed = f", {self.failed} failed" if self.failed else ""
            cases = "case" if total == 1 else "cases"
            self._show(f"{self.done}/{total} {cases}{failed}, {duration(self._elapsed())}")
        if self.done == total:
            self.stop()

    def step(self, step: str) -> None:
        """Show a step of a diagnosis; one that is a ``diagnose.progress.Step`` tells how far its stage is."""
        from wedgesweep.diagnose.work import Step

        if not isinstance(step, Step):
            self.stop()
            log.info(step)
            return
        if step.done == 0:
            self._begin(0, step.total)
        self.done = step.done
        self._show(step)

    def stop(self) -> None:
        """Remove the line of the terminal."""
        show_status("")

    def _begin(self, kept: int, total: int) -> None:
        self.done = self.kept = self._said_done = kept
        self.total = total
        self._began, self._said = perf_counter() - seconds_compiling(), perf_counter()

    def _elapsed(self) -> float:
        """Time (s) since the begin; what is compiled at first is not compiled again."""
        return perf_counter() - seconds_compiling() - self._began

    def _show(self, line: str) -> None:
        if self.kept < self.done < self.total:
            left = self._elapsed() / (self.done - self.kept) * (self.total - self.done)
            line = f"{line}, about {duration(left)} left"
        if shows_status():
            show_status(line)
        elif self._is_due():
            self._said, self._said_done = perf_counter(), self.done
            log.info(line)

    def _is_due(self) -> bool:
        silent = perf_counter() - self._said
        share = self.done - self._said_done >= LINE_SHARE * self.total
        return self.done in (0, self.total) or (share and silent >= LEAST_SECONDS) or silent >= LINE_SECONDS
