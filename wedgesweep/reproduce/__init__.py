"""The paper's claims, checked one by one on runs of its own cases."""

from collections.abc import Callable
from pathlib import Path

from wedgesweep import figures
from wedgesweep.reproduce import report as files
from wedgesweep.reproduce.claims import check
from wedgesweep.reproduce.page import PICTURES
from wedgesweep.reproduce.runs import Run, obtain
from wedgesweep.sweep import Progress

# Of a checkout; an installed package has none beside it.
CONFIGS = Path(__file__).parents[2] / "configs"


def reproduce(
    directory: Path,
    n_jobs: int,
    report: Callable[[str], None],
    progress: Progress | None = None,
    configs: Path = CONFIGS,
) -> bool:
    """Run the sweeps that ``directory`` lacks, check the claims, write reports and pictures there.

    ``report`` takes lines to show, ``progress`` is that of sweep.Sweep.run. Returns whether every
    verdict is the one on record. Raises ConfigError if ``configs`` does not hold the configs.
    """
    runs = obtain(directory, configs, n_jobs, report, progress or (lambda records, total: None))
    outcomes = []
    for outcome in check(runs):
        differs = "" if outcome.agrees else f" (on record: {outcome.recorded})"
        report(f"{outcome.claim.number:2} {outcome.verdict}{differs}: {outcome.claim.words}")
        outcomes.append(outcome)
    _draw(runs.paper, directory)
    files.write(directory, runs, outcomes)
    report(f"report: {directory / 'reproduction.md'}")
    return all(outcome.agrees for outcome in outcomes)


def _draw(run: Run, directory: Path) -> None:
    for kind in PICTURES:
        figures.save(figures.FIGURES[kind].draw(run.ds), directory / f"paper-{kind}.png")
