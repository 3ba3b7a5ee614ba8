"""Progress of a diagnosis: a line that is written over on a terminal, log lines elsewhere."""

from time import perf_counter
from typing import TYPE_CHECKING

from wedgesweep.cli.compiling import seconds_compiling
from wedgesweep.cli.humanize import duration
from wedgesweep.cli.messages import log, show_status, shows_status

if TYPE_CHECKING:
    from wedgesweep.diagnose.progress import Step

# Off a terminal there is a line for this share of a stage, or after so many seconds.
LINE_SHARE, LINE_SECONDS = 0.2, 10.0


class StepReport:
    """Called at each step of a diagnosis; shows how far its stage is, and how long the rest may take."""

    def __init__(self) -> None:
        self._began = self._said = perf_counter()
        self._said_done = 0

    def __call__(self, step: str) -> None:
        from wedgesweep.diagnose.progress import Step

        if not isinstance(step, Step):
            self.stop()
            log.info(step)
        else:
            if step.done == 0:
                self._began, self._said_done = perf_counter() - seconds_compiling(), -step.total
            self._show(step)

    def _show(self, step: "Step") -> None:
        line = str(step)
        if 0 < step.done < step.total:
            # What is compiled at the first step is not compiled again.
            spent = perf_counter() - seconds_compiling() - self._began
            left = spent / step.done * (step.total - step.done)
            line = f"{step}, about {duration(left)} left"
        if shows_status():
            show_status(line)
        elif self._is_due(step):
            log.info(line)

    def _is_due(self, step: "Step") -> bool:
        now = perf_counter()
        share = step.done - self._said_done >= LINE_SHARE * step.total
        if not (share or now - self._said > LINE_SECONDS or step.done == step.total):
            return False
        self._said, self._said_done = now, step.done
        return True

    def stop(self) -> None:
        """Remove the line of the terminal."""
        show_status("")
