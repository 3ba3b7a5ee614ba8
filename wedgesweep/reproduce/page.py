"""The readable page: answer, table, reasons, comparison of the laws, caveats, how it was run."""

from collections.abc import Iterable, Sequence
from typing import Any

from wedgesweep.reproduce.findings import CONTRADICTED, HOLDS, PARTLY

PICTURES = {
    "amplitude-ratio": "Amplitude ratio over frequency, the paper's Fig. 4",
    "stick-map": "Share of time stuck",
}


def render(content: dict[str, Any], experiment: str = "") -> str:
    """Markdown of ``report.document``, and of the section on the experiment."""
    sections = (
        "# Reproduction of the paper's claims",
        _answer(content),
        *_mismatches(content["claims"]),
        _claims(content["claims"]),
        *(f"![{text}](paper-{kind}.png)" for kind, text in PICTURES.items()),
        experiment,
        "## Why",
        *(_reason(claim) for claim in content["claims"]),
        "## The three laws on the same cases",
        _laws(content["laws"]),
        "## What the runs leave open",
        _cases(content["cases"]),
        "\n".join(f"- {case}" for case in content["failed"]),
        "## How it was run",
        _runs(content["runs"]),
    )
    return "\n\n".join(section for section in sections if section) + "\n"


def _answer(content: dict[str, Any]) -> str:
    verdicts = content["verdicts"]
    told = [f"{count} {_as_predicate(verdict, count)}" for verdict, count in verdicts.items()]
    contradicted = [
        f"{claim['claim']} (paper: {claim['paper']}; here: {claim['here']})"
        for claim in content["claims"]
        if claim["verdict"] == CONTRADICTED
    ]
    return (
        f"Of the paper's {sum(verdicts.values())} claims, {', '.join(told)}. "
        f"Contradicted: {'; '.join(contradicted) or 'none'}. {_unsettled(content['cases'])}"
    )


def _unsettled(rows: Sequence[dict[str, Any]]) -> str:
    paper = [row for row in rows if row["run"] == "paper"]
    unsettled, cases = (sum(row[key] for row in paper) for key in ("not_settled", "cases"))
    return f"{unsettled} of the {cases} cases have not settled when the run ends (see below)."


def _as_predicate(verdict: str, count: int) -> str:
    one, several = {
        HOLDS: ("holds", "hold"),
        PARTLY: ("holds in part", "hold in part"),
    }.get(verdict, (f"is {verdict}", f"are {verdict}"))
    return one if count == 1 else several


def _mismatches(claims: Sequence[dict[str, Any]]) -> list[str]:
    return [
        f"**Claim {claim['number']} is recorded as {claim['recorded']}, these runs say {claim['verdict']}.**"
        for claim in claims
        if claim["verdict"] != claim["recorded"]
    ]


def _claims(claims: Sequence[dict[str, Any]]) -> str:
    return table(
        ("", "claim", "paper", "here", "verdict"),
        ((c["number"], c["claim"], c["paper"], c["here"], f"**{c['verdict']}**") for c in claims),
    )


def _reason(claim: dict[str, Any]) -> str:
    lines = [
        f"### {claim['number']}. {claim['claim']}: {claim['verdict']}",
        "",
        claim["reason"],
        "",
    ]
    return "\n".join(lines + [_check(check) for check in claim["checks"]])


def _check(check: dict[str, Any]) -> str:
    if check["holds"] is None:
        return f"- {check['statement']}: not tested, {check['criterion']}."
    answer = "yes" if check["holds"] else "no"
    return f"- {check['statement']}: {number(check['here'])} ({check['criterion']}: {answer})."


def _laws(rows: Sequence[dict[str, Any]]) -> str:
    return (
        "Difference of two amplitude ratios over the larger one, all cases of paper.toml. Breakaway"
        " is the input at which set-valued friction begins to slip from rest, A/omega^2.\n\n"
        + table(
            ("laws", "inputs", "cases", "median", "largest", "at beta", "at a (mm)"),
            (
                (
                    " and ".join(row["laws"]),
                    row["inputs"],
                    row["cases"],
                    *(
                        number(row.get(key))
                        for key in (
                            "median",
                            "largest",
                            "largest_at_beta",
                            "largest_at_amplitude_mm",
                        )
                    ),
                )
                for row in rows
            ),
        )
    )


def _cases(rows: Sequence[dict[str, Any]]) -> str:
    return (
        "Not settled: the last two periods still differ by more than a thousandth of the input "
        "amplitude when the run ends (for paper.toml after the paper's 1.5 s). Lift-off: a normal "
        "force turns negative at some time, where a real wedge would part from its faces.\n\n"
        + table(
            (
                "run",
                "law",
                "cases",
                "failed",
                "not settled",
                "far from it",
                "with lift-off",
                "longest lift-off",
            ),
            (
                (
                    row["run"],
                    row["law"],
                    row["cases"],
                    ", ".join(f"{n} {word}" for word, n in row["failed"].items()) or "0",
                    row["not_settled"],
                    row["far_from_settled"],
                    row["lift_off"],
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
    used = next(iter(runs.values()))
    versions = {"wedgesweep": used["wedgesweep_version"], **used["package_versions"]}
    commit = f", commit `{used['git_commit']}`" if "git_commit" in used else ""
    return (
        table(("run", "cases", "solving time", "started", "config sha256"), rows)
        + "\n\nSolving time is the sum over all cases, whatever the number of jobs. "
        + ", ".join(f"{name} {version}" for name, version in versions.items())
        + f"{commit}. The resolved configs are in the datasets (attribute `config`)."
    )


def number(value: float | None) -> str:
    """A number with the digits that a reader needs."""
    return "-" if value is None else f"{value:.4g}"


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)
