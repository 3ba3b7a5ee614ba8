"""Entry point of the reproduction: ``PYTHONPATH=scripts python -m reproduce``.

Runs the paper's cases, checks its claims, and tests which hypotheses explain Chandiramani's experiment, with
which the paper compares its results. Takes 40 minutes on two cores; finished cases stay in the output
directory: rerun the same command to resume. Exits with code 1 if a verdict differs from the recorded one.
"""

import argparse
import json
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from reproduce import chandiramani, chandiramani_page, figure, published
from reproduce.claims import check
from reproduce.report import FIGURES, document, render
from reproduce.runs import obtain
from reproduce.writing import plain, write_json
from wedgesweep import figures
from wedgesweep.cli.compiling import announce_compiling
from wedgesweep.cli.progress import ProgressReport
from wedgesweep.files import write_text
from wedgesweep.sweep.backend import count_jobs
from wedgesweep.sweep.run import Progress

CONFIGS = Path(__file__).parents[2] / "configs"
CLAIMS, CHANDIRAMANI = "claims", "chandiramani"


def arguments(given: Sequence[str] | None = None) -> argparse.Namespace:
    """Read the options of the command line."""
    parser = argparse.ArgumentParser(prog="python -m reproduce", description=__doc__, allow_abbrev=False)
    parser.add_argument("-o", "--output", type=Path, default=Path("out/reproduction"), help="directory")
    parser.add_argument(
        "--only", choices=(CLAIMS, CHANDIRAMANI), help="only the paper's claims, or only the hypotheses"
    )
    parser.add_argument("--n-jobs", type=int, help="parallel jobs; default: one per processor")
    return parser.parse_args(given)


def main(given: Sequence[str] | None = None) -> int:
    """Return the exit code: 0 if all verdicts are as recorded."""
    options = arguments(given)
    announce_compiling()
    report = partial(print, flush=True)
    jobs = count_jobs(options.n_jobs)
    return 0 if reproduce(options.output, jobs, report, ProgressReport().cases, options.only) else 1


def reproduce(
    directory: Path, n_jobs: int, report: Callable[[str], None], progress: Progress, only: str | None = None
) -> bool:
    """Check the claims and search the hypotheses; write reports and figures into ``directory``.

    Finished sweeps that it holds are kept. ``only``: CLAIMS or CHANDIRAMANI. Returns whether all verdicts are
    as recorded.
    """
    # The report on the claims includes the hypotheses: these come first.
    agrees = only == CLAIMS or _search_hypotheses(directory, n_jobs, report)
    if only != CHANDIRAMANI:
        agrees &= _check_claims(directory, n_jobs, report, progress)
    return agrees


def _check_claims(directory: Path, n_jobs: int, report: Callable[[str], None], progress: Progress) -> bool:
    """Run the sweeps that ``directory`` lacks and check the claims."""
    runs = obtain(directory, CONFIGS, n_jobs, report, progress)
    claims = []
    for each in check(runs):
        verdict = each.finding.verdict
        differs = "" if each.agrees else f" (on record: {each.claim.recorded})"
        report(f"{each.claim.number:2} {verdict}{differs}: {each.claim.statement}")
        claims.append(each)
    for kind in FIGURES:
        figures.save(figures.draw(runs.paper.ds, kind), directory / f"paper-{kind}.png")
    oscillators = published.check(CONFIGS)
    for number in oscillators:
        if not number.holds:
            report(f"{number.statement}: {number.here} (published: {number.criterion})")
    content = document(runs, claims, oscillators)
    write_json(directory / "reproduction.json", content)
    write_text(directory / "reproduction.md", render(content, _experiment(directory)))
    report(f"report: {directory / 'reproduction.md'}")
    return bool(content["agrees"])


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
    content = plain(chandiramani.document(found))
    report(chandiramani_page.answer(content))
    if not found.agrees:
        report(f"on record: {chandiramani.RECORDED}")
    write_json(directory / "chandiramani.json", content)
    write_text(directory / "chandiramani.md", chandiramani_page.render(content))
    drawn = figure.draw(content["hertz"], content["hypotheses"])
    figures.save(drawn, directory / chandiramani_page.PICTURE)
    report(f"report: {directory / 'chandiramani.md'}")
    return found.agrees


if __name__ == "__main__":
    raise SystemExit(main())
