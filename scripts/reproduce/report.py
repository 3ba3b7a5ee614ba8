"""The report on the claims: answer, table, reasons, limits, how it was run; as data and in Markdown."""

import json
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

from reproduce.claims import CheckedClaim
from reproduce.findings import CONTRADICTED, HOLDS, PARTLY, VERDICTS, Check, Finding
from reproduce.runs import LAWS, Run, Runs
from reproduce.writing import number, plain, table
from wedgesweep.outcome import SETTLED
from wedgesweep.sweep import outcomes
from wedgesweep.sweep.variables import STATUSES

FIGURES = {
    "amplitude-ratio": "Amplitude ratio over frequency, the paper's Fig. 4",
    "stick-map": "Share of time stuck",
}
# A case is far from settled if its last two periods differ by more than this share of the input amplitude.
FAR_FROM_SETTLED = 0.1
PROVENANCE = ("start_time", "config_sha256", "wedgesweep_version", "git_commit")
Rows = Sequence[dict[str, Any]]


def document(runs: Runs, claims: Sequence[CheckedClaim], published: Sequence[Check]) -> dict[str, Any]:
    """The content of the report as plain data."""
    verdicts = Counter(claim.finding.verdict for claim in claims)
    return plain(
        {
            "agrees": all(claim.agrees for claim in claims) and all(check.holds for check in published),
            "verdicts": {verdict: n for verdict in VERDICTS if (n := verdicts[verdict])},
            "claims": [_claim(claim) for claim in claims],
            "published": [vars(check) for check in published],
            "cases": [_cases_of(name, run, law) for name, run in runs.named.items() for law in LAWS],
            "failed": [f"{name}: {case}" for name, run in runs.named.items() for case in _failed(run)],
            "runs": {name: _provenance(run) for name, run in runs.named.items()},
        }
    )


def _claim(checked: CheckedClaim) -> dict[str, Any]:
    claim, unilateral = checked.claim, checked.unilateral
    return {
        "number": claim.number,
        "claim": claim.statement,
        "paper": claim.paper,
        **_finding(checked.finding, claim.recorded),
        "reason": checked.finding.reason,
        **({"unilateral": _finding(unilateral, claim.unilateral)} if unilateral else {}),
    }


def _finding(found: Finding, recorded: str | None) -> dict[str, Any]:
    checks = [vars(check) for check in found.checks]
    return {"here": found.here, "verdict": found.verdict, "recorded": recorded, "checks": checks}


def _cases_of(name: str, run: Run, law: str) -> dict[str, Any]:
    """Number of cases of a law, of failures, of cases not settled and of cases with lift-off."""
    ds = run.law(law)
    failed = Counter(STATUSES[status] for status in ds["status"].values.ravel() if status)
    return {
        "run": name,
        "law": law,
        "cases": ds["status"].size,
        "failed": failed,
        "not_settled": int((ds["periodicity"] > SETTLED).sum()),
        "far_from_settled": int((ds["periodicity"] > FAR_FROM_SETTLED).sum()),
        "lift_off": int((ds["lift_off_fraction"] > 0.0).sum()),
        "largest_lift_off_fraction": float(ds["lift_off_fraction"].max()),
    }


def _failed(run: Run) -> list[str]:
    return [outcomes.described(run.ds, place) for place in outcomes.failures(run.ds).tolist()]


def _provenance(run: Run) -> dict[str, Any]:
    attributes = run.ds.attrs
    return {
        "cases": run.ds["status"].size,
        "solving_time_s": round(float(run.ds["wall_time"].sum()), 1),
        **{name: attributes[name] for name in PROVENANCE if name in attributes},
        "package_versions": json.loads(attributes["package_versions"]),
    }


def render(content: dict[str, Any], experiment: str = "") -> str:
    """Markdown of ``document`` with the section on the experiment, if it was searched."""
    rows = (
        (c["number"], c["claim"], c["paper"], c["here"], f"**{c['verdict']}**") for c in content["claims"]
    )
    sections = (
        "# Reproduction of the paper's claims",
        _answer(content),
        *_mismatches(content["claims"]),
        table(("", "claim", "paper", "here", "verdict"), rows),
        *(f"![{text}](paper-{kind}.png)" for kind, text in FIGURES.items()),
        experiment,
        "## Reasons",
        *map(_reason, content["claims"]),
        "## Published numbers of other oscillators",
        "\n".join(map(_check, content["published"])),
        "## Limits of the runs",
        _limits(content["cases"]),
        "\n".join(f"- {case}" for case in content["failed"]),
        "## How it was run",
        _runs(content["runs"]),
    )
    return "\n\n".join(section for section in sections if section) + "\n"


def _answer(content: dict[str, Any]) -> str:
    verdicts = content["verdicts"]
    counts = ", ".join(f"{count} {_predicate(verdict, count)}" for verdict, count in verdicts.items())
    contradicted = "; ".join(
        f"{claim['claim']} (paper: {claim['paper']}; here: {claim['here']})"
        for claim in content["claims"]
        if claim["verdict"] == CONTRADICTED
    )
    paper = [row for row in content["cases"] if row["run"] == "paper"]
    unsettled, cases = (sum(row[key] for row in paper) for key in ("not_settled", "cases"))
    return (
        f"Of the paper's {sum(verdicts.values())} claims, {counts}. Contradicted: {contradicted or 'none'}. "
        f"{unsettled} of the {cases} cases have not settled when the run ends (see below)."
    )


def _predicate(verdict: str, count: int) -> str:
    words = {HOLDS: ("holds", "hold"), PARTLY: ("holds in part", "hold in part")}
    one, several = words.get(verdict, (f"is {verdict}", f"are {verdict}"))
    return one if count == 1 else several


def _mismatches(claims: Rows) -> Iterator[str]:
    for claim in claims:
        for joints, found in (("", claim), (" with unilateral joints", claim.get("unilateral"))):
            if found and found["verdict"] != found["recorded"]:
                recorded = f"is recorded as {found['recorded']}, these runs say {found['verdict']}"
                yield f"**Claim {claim['number']}{joints} {recorded}.**"


def _reason(claim: dict[str, Any]) -> str:
    title = f"### {claim['number']}. {claim['claim']}: {claim['verdict']}"
    lines = [title, "", claim["reason"], "", *map(_check, claim["checks"])]
    if "unilateral" in claim:
        found = claim["unilateral"]
        sentence = f"With joints that lift off the claim {_predicate(found['verdict'], 1)}: {found['here']}."
        lines += ["", sentence, "", *map(_check, found["checks"])]
    return "\n".join(lines)


def _check(check: dict[str, Any]) -> str:
    if check["holds"] is None:
        return f"- {check['statement']}: not tested, {check['criterion']}."
    answer = "yes" if check["holds"] else "no"
    return f"- {check['statement']}: {number(check['here'])} ({check['criterion']}: {answer})."


def _limits(rows: Rows) -> str:
    flags = ("not settled", "far from settled", "lift-off", "longest lift-off")
    cells = (
        (
            *(row[key] for key in ("run", "law", "cases")),
            ", ".join(f"{n} {status}" for status, n in row["failed"].items()) or "0",
            *(row[key] for key in ("not_settled", "far_from_settled", "lift_off")),
            f"{number(row['largest_lift_off_fraction'])} of the time",
        )
        for row in rows
    )
    return (
        "Not settled: the last two periods still differ by more than a thousandth of the input amplitude "
        "when the run ends (for paper.toml after the paper's 1.5 s). Lift-off: a normal force becomes "
        "negative at some time, where a real wedge would separate from its faces; with joints that lift off, "
        f"a contact opens.\n\n{table(('run', 'law', 'cases', 'failed', *flags), cells)}"
    )


def _runs(runs: dict[str, dict[str, Any]]) -> str:
    rows = (
        (
            name,
            run["cases"],
            f"{run['solving_time_s']:.0f} s",
            run["start_time"],
            f"`{run['config_sha256'][:16]}`",
        )
        for name, run in runs.items()
    )
    first = next(iter(runs.values()))
    versions = {"wedgesweep": first["wedgesweep_version"], **first["package_versions"]}
    used = ", ".join(f"{name} {version}" for name, version in versions.items())
    commit = f", commit `{first['git_commit']}`" if "git_commit" in first else ""
    return (
        table(("run", "cases", "solving time", "started", "config sha256"), rows)
        + "\n\nThe solving time is the sum over all cases, whatever the number of jobs. "
        + f"Versions: {used}{commit}. The datasets contain the resolved configs (attribute `config`)."
    )
