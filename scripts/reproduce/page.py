"""The readable report: answer, table, reasons, comparison of the laws, limits, how it was run."""

from collections.abc import Iterator, Sequence
from typing import Any

from reproduce.findings import CONTRADICTED, HOLDS, PARTLY
from reproduce.markdown import number, table

FIGURES = {
    "amplitude-ratio": "Amplitude ratio over frequency, the paper's Fig. 4",
    "stick-map": "Share of time stuck",
}
Rows = Sequence[dict[str, Any]]


def render(content: dict[str, Any], experiment: str = "") -> str:
    """Markdown of ``report.document`` with the section on the experiment."""
    sections = (
        "# Reproduction of the paper's claims",
        _answer(content),
        *_mismatches(content["claims"]),
        _claims(content["claims"]),
        *(f"![{text}](paper-{kind}.png)" for kind, text in FIGURES.items()),
        experiment,
        "## Reasons",
        *(_reason(claim) for claim in content["claims"]),
        "## Published numbers of other oscillators",
        "\n".join(map(_check, content["published"])),
        "## The three laws on the same cases",
        _laws(content["laws"]),
        "## Limits of the runs",
        _cases(content["cases"]),
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
    one, several = {
        HOLDS: ("holds", "hold"),
        PARTLY: ("holds in part", "hold in part"),
    }.get(verdict, (f"is {verdict}", f"are {verdict}"))
    return one if count == 1 else several


def _mismatches(claims: Rows) -> Iterator[str]:
    for claim in claims:
        for joints, found in (("", claim), (" with unilateral joints", claim.get("unilateral"))):
            if found and found["verdict"] != found["recorded"]:
                recorded = f"is recorded as {found['recorded']}, these runs say {found['verdict']}"
                yield f"**Claim {claim['number']}{joints} {recorded}.**"


def _claims(claims: Rows) -> str:
    return table(
        ("", "claim", "paper", "here", "verdict"),
        ((c["number"], c["claim"], c["paper"], c["here"], f"**{c['verdict']}**") for c in claims),
    )


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


def _laws(rows: Rows) -> str:
    numbers = ("median", "largest", "largest_at_beta", "largest_at_amplitude_mm")
    return (
        "Difference of two amplitude ratios over the larger one, for all cases of paper.toml. Breakaway is "
        "the input at which set-valued friction begins to slip from rest, A/omega^2.\n\n"
        + table(
            ("laws", "inputs", "cases", "median", "largest", "at beta", "at a (mm)"),
            (
                (
                    " and ".join(row["laws"]),
                    row["inputs"],
                    row["cases"],
                    *(number(row.get(n)) for n in numbers),
                )
                for row in rows
            ),
        )
    )


def _cases(rows: Rows) -> str:
    flags = ("not settled", "far from settled", "lift-off", "longest lift-off")
    return (
        "Not settled: the last two periods still differ by more than a thousandth of the input amplitude "
        "when the run ends (for paper.toml after the paper's 1.5 s). Lift-off: a normal force becomes "
        "negative at some time, where a real wedge would separate from its faces; with joints that lift off, "
        "a contact opens.\n\n"
        + table(
            ("run", "law", "cases", "failed", *flags),
            (
                (
                    *(row[key] for key in ("run", "law", "cases")),
                    ", ".join(f"{n} {status}" for status, n in row["failed"].items()) or "0",
                    *(row[key] for key in ("not_settled", "far_from_settled", "lift_off")),
                    f"{number(row['largest_lift_off_fraction'])} of the time",
                )
                for row in rows
            ),
        )
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
