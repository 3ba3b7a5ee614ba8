"""The paper's claims, checked one by one on runs of its own cases, and the question that it leaves open."""

import json
from collections.abc import Callable
from pathlib import Path

from wedgesweep import figures
from wedgesweep.figures import hypotheses as picture
from wedgesweep.reproduce import chandiramani, chandiramani_page, observations
from wedgesweep.reproduce import report as files
from wedgesweep.reproduce.claims import check
from wedgesweep.reproduce.page import PICTURES
from wedgesweep.reproduce.runs import Run, obtain
from wedgesweep.sweep.run import Progress

# Of a checkout; an installed package has none beside it.
CONFIGS = Path(__file__).parents[2] / "configs"


def reproduce(
    directory: Path,
    n_jobs: int,
    report: Callable[[str], None],
    progress: Progress | None = None,
    configs: Path = CONFIGS,
    only: str | None = None,
) -> bool:
    """Check the claims and the suspects, or ``only`` "claims" or "chandiramani"; write reports and pictures.

    ``report`` takes lines to show, ``progress`` is that of sweep.Sweep.run. Returns whether everything is
    as it is on record. Raises ConfigError if ``configs`` does not hold the configs.
    """
    # The page on the claims tells of the suspects, too: these come first.
    agree = only == "claims" or _suspects(directory, n_jobs, report)
    if only != "chandiramani":
        agree &= _claims(directory, n_jobs, report, progress, configs)
    return agree


def _claims(
    directory: Path,
    n_jobs: int,
    report: Callable[[str], None],
    progress: Progress | None,
    configs: Path,
) -> bool:
    """Run the sweeps that ``directory`` lacks and check the claims."""
    runs = obtain(directory, configs, n_jobs, report, progress or (lambda records, total: None))
    outcomes = []
    for outcome in check(runs):
        differs = "" if outcome.agrees else f" (on record: {outcome.recorded})"
        report(f"{outcome.claim.number:2} {outcome.verdict}{differs}: {outcome.claim.words}")
        outcomes.append(outcome)
    _draw(runs.paper, directory)
    files.write(directory, runs, outcomes, _experiment(directory))
    report(f"report: {directory / 'reproduction.md'}")
    return all(outcome.agrees for outcome in outcomes)


def _experiment(directory: Path) -> str:
    """Section on the experiment, if it was searched into this directory."""
    path = directory / "chandiramani.json"
    if not path.exists():
        return ""
    return chandiramani_page.summary(json.loads(path.read_text(encoding="utf-8")))


def _suspects(directory: Path, n_jobs: int, report: Callable[[str], None]) -> bool:
    """Search the suspects of the experiment; takes minutes."""
    directory.mkdir(parents=True, exist_ok=True)
    outcome = chandiramani.investigate(n_jobs, report)
    content = files.plain(chandiramani.document(outcome))
    report(chandiramani_page.answer(content))
    if not outcome.agrees:
        report(f"on record: {chandiramani.RECORDED}")
    files.write_text(directory / "chandiramani.json", files.json_text(content))
    files.write_text(directory / "chandiramani.md", chandiramani_page.render(content))
    figure = picture.draw(
        content["hertz"],
        content["suspects"],
        observations.LEVELS,
        observations.LEVEL_FACTOR,
        observations.JUMP_HERTZ,
    )
    figures.save(figure, directory / chandiramani_page.PICTURE)
    report(f"report: {directory / 'chandiramani.md'}")
    return outcome.agrees


def _draw(run: Run, directory: Path) -> None:
    for kind in PICTURES:
        figures.save(figures.draw(run.ds, kind), directory / f"paper-{kind}.png")
