"""The result of a reproduction as data (reproduction.json) and as a report (reproduction.md)."""

import json
from collections import Counter
from collections.abc import Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from reproduce import comparison, page
from reproduce.claims import CheckedClaim
from reproduce.findings import VERDICTS, Check
from reproduce.runs import Run, Runs
from wedgesweep.files import write_text


def write(
    directory: Path,
    runs: Runs,
    claims: Sequence[CheckedClaim],
    published: Sequence[Check],
    experiment: str = "",
) -> None:
    """Write both files; ``experiment`` is the section on the experiment, if it was searched."""
    content = document(runs, claims, published)
    write_text(directory / "reproduction.json", json_text(content))
    write_text(directory / "reproduction.md", page.render(content, experiment))


def json_text(content: dict[str, Any]) -> str:
    """Plain data as JSON."""
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def document(runs: Runs, claims: Sequence[CheckedClaim], published: Sequence[Check]) -> dict[str, Any]:
    """The content of both files."""
    verdicts = Counter(claim.verdict for claim in claims)
    return plain(
        {
            "agrees": all(claim.agrees for claim in claims) and all(check.holds for check in published),
            "verdicts": {verdict: n for verdict in VERDICTS if (n := verdicts[verdict])},
            "claims": [_claim(claim) for claim in claims],
            "published": [vars(check) for check in published],
            "laws": comparison.laws(runs.paper),
            "cases": comparison.caveats(runs),
            "failed": comparison.failed_cases(runs),
            "runs": {name: _run(run) for name, run in runs.named.items()},
        }
    )


def _claim(checked: CheckedClaim) -> dict[str, Any]:
    unilateral = checked.unilateral
    return {
        "number": checked.claim.number,
        "claim": checked.claim.statement,
        "paper": checked.claim.paper,
        **_finding(checked),
        "reason": checked.reason,
        **({} if unilateral is None else {"unilateral": _finding(unilateral)}),
    }


def _finding(checked: CheckedClaim) -> dict[str, Any]:
    return {
        "here": checked.here,
        "verdict": checked.verdict,
        "recorded": checked.recorded,
        "checks": [vars(check) for check in checked.finding.checks],
        "numbers": checked.finding.numbers,
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
    """Convert to lists, dicts and Python numbers; numbers that are not finite become None."""
    if isinstance(value, dict):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and not isfinite(value) else value
