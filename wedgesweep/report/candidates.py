"""The candidates: how well each explains the tests, and which are rivals of the best one."""

from typing import Any

from wedgesweep import formatting
from wedgesweep.diagnosis_result import FAILED, NO_BETTER, DiagnosisResult
from wedgesweep.effects import EFFECTS, stray_vibration
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup
from wedgesweep.report.inline_figures import InlineFigures

ROWS_SHOWN = 12
TEXT_COLUMNS = 3
HEAD = (
    "candidate",
    "parameters (95 % intervals)",
    "status",
    "Q",
    "dof",
    "p",
    "behind the best",
    "score",
    "retention",
)

NO_RIVAL = "No other explanation comes close enough to the best one to be confused with it."
NO_CAUSE = "No cause is named, so there are no rivals to it."


def section(result: DiagnosisResult, draw: InlineFigures) -> Markup:
    """Section with the ranking and a table."""
    candidates = result.document["candidates"]
    rows = [_row(each, _best(candidates)) for each in candidates]
    caption = "The best candidates" if len(rows) > ROWS_SHOWN else "All candidates"
    others = html.details(
        f"{len(rows) - ROWS_SHOWN} more",
        html.table("Other candidates", HEAD, rows[ROWS_SHOWN:], TEXT_COLUMNS),
    )
    return html.section(
        "candidates",
        "The candidates",
        html.paragraph(_summary(result)),
        draw("candidates", _ranking(result)),
        html.table(caption, HEAD, rows[:ROWS_SHOWN], TEXT_COLUMNS),
        others if len(rows) > ROWS_SHOWN else Markup(),
        html.details("How to read the columns", *map(html.paragraph, COLUMNS)),
    )


COLUMNS = (
    "Q is the squared distance between model and measurement in units of the noise, summed over all "
    "compared numbers. A correct model leaves Q close to dof, the degrees of freedom; p is the probability "
    "that noise alone leaves more.",
    "“Behind the best” compares Q plus a penalty for each fitted parameter. A candidate that is behind by "
    "less than the tie width cannot be distinguished from the best.",
    "The score says, before anything is fitted, how clearly the misfit of the base model points to this one "
    "candidate. Retention is the share of its signal that start phases, amplitudes and uncertain parameters "
    "cannot imitate.",
)


def _best(candidates: list[dict[str, Any]]) -> float | None:
    return min((each["penalised"] for each in candidates if each["penalised"] is not None), default=None)


def _summary(result: DiagnosisResult) -> str:
    sizes = [len(each["effects"]) for each in result.document["candidates"]]
    singles, pairs = sizes.count(1), sum(size > 1 for size in sizes)
    fitted = f"Besides the base model, {formatting.counted(singles, 'single candidate')} "
    fitted += "was fitted" if singles == 1 else "were fitted"
    if pairs:
        best = "the pair" if pairs == 1 else f"the {pairs} pairs"
        fitted += f", and {best} that looked best on some of the tests"
    return f"{fitted}.{_without_parameters(result)}{_not_fitted(result)}"


def _without_parameters(result: DiagnosisResult) -> str:
    status = [each["status"] for each in result.document["candidates"]]
    failed, no_better = status.count(FAILED), status.count(NO_BETTER)
    return (f" {formatting.counted(failed, 'fit')} failed." if failed else "") + (
        f" {formatting.counted(no_better, 'fit')} ended no better than the base model." if no_better else ""
    )


def _not_fitted(result: DiagnosisResult) -> str:
    """Effects that were not fitted because the tests cannot show them, or have no spurious tone."""
    document = result.document
    fitted = {effect for each in document["candidates"] for effect in each["effects"]}
    left = sorted({*document["detectable"], *document["not_testable"]} - fitted)
    tone, steady = stray_vibration.EFFECT.name, document.get("kind", "steady") == "steady"
    others = [effect for effect in left if not (steady and effect == tone)]
    hidden = f" Not fitted, as these tests cannot show them: {phrases.listing(others)}." if others else ""
    return hidden + (
        f" Not fitted, as no test has a spurious tone: {tone}." if len(others) < len(left) else ""
    )


def _ranking(result: DiagnosisResult) -> str:
    fitted = [each for each in result.document["candidates"] if each["penalised"] is not None]
    if len(fitted) < 2:
        return "Only one model could be fitted."
    first, second = fitted[:2]
    behind = formatting.number(second["penalised"] - first["penalised"])
    return (
        f"The best candidate is {phrases.combination(first['effects'])}, the next one "
        f"{phrases.combination(second['effects'])}, behind by {behind}. Filled marks leave only noise."
    )


def _row(each: dict[str, Any], best: float | None) -> list[object]:
    behind = None if each["penalised"] is None or best is None else each["penalised"] - best
    parameters = [phrases.compact(_own(key, each), value) for key, value in each["parameters"].items()]
    return [
        _name(each),
        "; ".join(parameters) or formatting.NONE,
        each["status"],
        formatting.number(each["q"], 4),
        each["dof"],
        phrases.probability(each["p"]),
        formatting.number(behind),
        formatting.number(each["score"]),
        formatting.percent(each["retention"]),
    ]


def _own(key: str, each: dict[str, Any]) -> str:
    """Key of a parameter, without its effect if there is only one."""
    effect, own = key.split(".", 1)
    return own if len(each["effects"]) == 1 else f"{effect} {own}"


def _name(each: dict[str, Any]) -> str:
    families = dict.fromkeys(EFFECTS[name].family for name in each["effects"] if name in EFFECTS)
    return phrases.combination(each["effects"]) + (f" ({', '.join(families)})" if families else "")


def rivals(result: DiagnosisResult) -> Markup:
    """Section with a table of the rivals."""
    rows = [
        [
            phrases.combination(each["effects"]),
            "; ".join(phrases.meaning(effect, result.document) for effect in each["effects"]),
            formatting.number(each["gap"], 2),
        ]
        for each in result.document["rivals"]
    ]
    named = bool(result.document["causes"])
    caption = "Other adequate explanations" if named else "Adequate explanations"
    behind = f"penalised misfit less that of the {'cause' if named else 'best'}"
    table = html.table(caption, ("explanation", "meaning", behind), rows, 2)
    return html.section(
        "rivals", "Rival explanations", table if rows else html.paragraph(NO_RIVAL if named else NO_CAUSE)
    )
