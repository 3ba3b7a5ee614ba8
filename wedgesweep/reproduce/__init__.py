"""The paper's claims, checked on runs of its own cases, and hypotheses on the experiment it leaves open."""

import json
from collections.abc import Callable
from pathlib import Path

from wedgesweep import figures
from wedgesweep.figures import hypotheses as figure_of_hypotheses
from wedgesweep.reproduce import chandiramani, chandiramani_page, observations, published
from wedgesweep.reproduce import report as files
from wedgesweep.reproduce.claims import check
from wedgesweep.reproduce.page import FIGURES
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
    """Check the claims and search the hypotheses; write reports and figures.

    Parameters
    ----------
    directory : Path
        Where datasets, reports and figures go; finished sweeps that it holds are kept.
    n_jobs : int
        Number of parallel jobs.
    report : callable
        Takes lines to show.
    progress : callable, optional
        As of sweep.run.Sweep.run.
    configs : Path
        Directory of the configs.
    only : str, optional
        "claims" or "chandiramani" (the hypotheses).

    Returns
    -------
    bool
        Whether all verdicts are as recorded.

    Raises
    ------
    ConfigError
        If ``configs`` does not hold the configs.
    """
    # The report on the claims includes the hypotheses: these come first.
    agrees = only == "claims" or _search_hypotheses(directory, n_jobs, report)
    if only != "chandiramani":
        agrees &= _check_claims(directory, n_jobs, report, progress, configs)
    return agrees


def _check_claims(
    directory: Path,
    n_jobs: int,
    report: Callable[[str], None],
    progress: Progress | None,
    configs: Path,
) -> bool:
    """Run the sweeps that ``directory`` lacks and check the claims."""
    runs = obtain(directory, configs, n_jobs, report, progress or (lambda records, total: None))
    claims = []
    for each in check(runs):
        differs = "" if each.agrees else f" (on record: {each.recorded})"
        report(f"{each.claim.number:2} {each.verdict}{differs}: {each.claim.statement}")
        claims.append(each)
    _draw(runs.paper, directory)
    oscillators = published.check(configs)
    for number in oscillators:
        if not number.holds:
            report(f"{number.statement}: {number.here} (published: {number.criterion})")
    files.write(directory, runs, claims, oscillators, _experiment(directory))
    report(f"report: {directory / 'reproduction.md'}")
    return all(each.agrees for each in claims) and all(number.holds for number in oscillators)


def _experiment(directory: Path) -> str:
    """Section on the experiment, if its hypotheses were searched into this directory."""
    path = directory / "chandiramani.json"
    if not path.exists():
        return ""
    return chandiramani_page.summary(json.loads(path.read_text(encoding="utf-8")))


def _search_hypotheses(directory: Path, n_jobs: int, report: Callable[[str], None]) -> bool:
    """Search the hypotheses on the experiment; takes minutes."""
    directory.mkdir(parents=True, exist_ok=True)
    found = chandiramani.investigate(n_jobs, report)
    content = files.plain(chandiramani.document(found))
    report(chandiramani_page.answer(content))
    if not found.agrees:
        report(f"on record: {chandiramani.RECORDED}")
    files.write_text(directory / "chandiramani.json", files.json_text(content))
    files.write_text(directory / "chandiramani.md", chandiramani_page.render(content))
    figure = figure_of_hypotheses.draw(
        content["hertz"],
        content["hypotheses"],
        observations.LEVELS,
        observations.LEVEL_FACTOR,
        observations.JUMP_HERTZ,
    )
    figures.save(figure, directory / chandiramani_page.PICTURE)
    report(f"report: {directory / 'chandiramani.md'}")
    return found.agrees


def _draw(run: Run, directory: Path) -> None:
    for kind in FIGURES:
        figures.save(figures.draw(run.ds, kind), directory / f"paper-{kind}.png")
