"""The outcome of a reproduction as data (reproduction.json) and as a page (reproduction.md)."""

import json
import os
from collections import Counter
from collections.abc import Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from wedgesweep.reproduce import comparison, page
from wedgesweep.reproduce.claims import Outcome
from wedgesweep.reproduce.findings import VERDICTS
from wedgesweep.reproduce.runs import Run, Runs


def write(directory: Path, runs: Runs, outcomes: Sequence[Outcome], experiment: str = "") -> None:
    """Write both files; ``experiment`` is the page's section on the experiment, where it was searched."""
    content = document(runs, outcomes)
    write_text(directory / "reproduction.json", json_text(content))
    write_text(directory / "reproduction.md", page.render(content, experiment))


def json_text(content: dict[str, Any]) -> str:
    """Plain data as JSON."""
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def write_text(path: Path, text: str) -> None:
    """Write a file whole or not at all."""
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        partial.write_text(text, encoding="utf-8")
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def document(runs: Runs, outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Everything that both files say."""
    verdicts = Counter(outcome.verdict for outcome in outcomes)
    return plain(
        {
            "agrees": all(outcome.agrees for outcome in outcomes),
            "verdicts": {verdict: n for verdict in VERDICTS if (n := verdicts[verdict])},
            "claims": [_claim(outcome) for outcome in outcomes],
            "laws": comparison.laws(runs.paper),
            "cases": comparison.caveats(runs),
            "failed": comparison.failed_cases(runs),
            "runs": {name: _run(run) for name, run in runs.named.items()},
        }
    )


def _claim(outcome: Outcome) -> dict[str, Any]:
    return {
        "number": outcome.claim.number,
        "claim": outcome.claim.words,
        "paper": outcome.claim.paper,
        "here": outcome.here,
        "verdict": outcome.verdict,
        "recorded": outcome.recorded,
        "reason": outcome.reason,
        "checks": [vars(check) for check in outcome.finding.checks],
        "numbers": outcome.finding.numbers,
    }


def _run(run: Run) -> dict[str, Any]:
    attributes = run.ds.attrs
    return {
        "title": attributes["title"],
        "cases": run.ds["status"].size,
        "solving_time_s": round(float(run.ds["wall_time"].sum()), 1),
        **{
            name: attributes[name]
            for name in ("start_time", "config_sha256", "wedgesweep_version", "git_commit")
            if name in attributes
        },
        "package_versions": json.loads(attributes["package_versions"]),
    }


def plain(value: Any) -> Any:
    """Lists, dicts and Python numbers only; what is not finite becomes None."""
    if isinstance(value, dict):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and not isfinite(value) else value
