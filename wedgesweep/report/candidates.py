"""The candidates: what was tried, and how well each explains the tests."""

from typing import Any

from wedgesweep import digits
from wedgesweep.diagnosed import FAILED, NO_BETTER, Diagnosed
from wedgesweep.effects import EFFECTS
from wedgesweep.report import html, words
from wedgesweep.report.html import Markup
from wedgesweep.report.pictures import Pictures

SHOWN = 12
HEAD = (
    "candidate",
    "numbers (95 % intervals)",
    "status",
    "Q",
    "dof",
    "p",
    "behind the best",
    "score",
    "retention",
)


def section(found: Diagnosed, draw: Pictures) -> Markup:
    """Section with the ranking and a table."""
    candidates = found.document["candidates"]
    rows = [_row(each, _best(candidates)) for each in candidates]
    first = html.table(
        "The best candidates" if len(rows) > SHOWN else "All candidates", HEAD, rows[:SHOWN], 3
    )
    rest = rows[SHOWN:]
    return html.section(
        "candidates",
        "The candidates",
        html.paragraph(_summary(found)),
        draw("candidates", _ranking(found)),
        first,
        html.details(f"{len(rest)} more", html.table("Other candidates", HEAD, rest, 3))
        if rest
        else Markup(),
        html.details("How to read the columns", *map(html.paragraph, COLUMNS)),
    )


COLUMNS = (
    "Q is the squared distance of model and measurement over the noise, summed over all harmonics. A right "
    "model leaves about dof, and p is the probability that noise alone leaves more.",
    "Behind the best: how much larger Q is with a penalty for each fitted number. Less than the tie width "
    "cannot be told apart.",
    "The score says how clearly the misfit of the base model points towards a single candidate before "
    "anything is fitted; retention is the share of its signal that phases, amplitudes and uncertain "
    "numbers cannot imitate.",
)


def _best(candidates: list[dict[str, Any]]) -> float | None:
    found = [each["penalised"] for each in candidates if each["penalised"] is not None]
    return min(found, default=None)


def _summary(found: Diagnosed) -> str:
    effects = [each["effects"] for each in found.document["candidates"]]
    pairs = sum(len(each) > 1 for each in effects)
    singles = words.counted(sum(len(each) == 1 for each in effects), "single candidate")
    best = (
        f", and {words.counted(pairs, 'pair')}, those that looked best on some of the tests" if pairs else ""
    )
    return f"Beside the base model {singles} were fitted{best}.{_without_numbers(found)}{_unheard(found)}"


def _without_numbers(found: Diagnosed) -> str:
    status = [each["status"] for each in found.document["candidates"]]
    failed, no_better = status.count(FAILED), status.count(NO_BETTER)
    return (f" {words.counted(failed, 'fit')} failed." if failed else "") + (
        f" {words.counted(no_better, 'fit')} ended no better than the base model, far from what it does best."
        if no_better
        else ""
    )


def _unheard(found: Diagnosed) -> str:
    """The effect that was not fitted, as no test has a foreign tone."""
    document = found.document
    fitted = {effect for each in document["candidates"] for effect in each["effects"]}
    left = sorted({*document["detectable"], *document["not_testable"]} - fitted)
    return f" Not fitted, as nothing is heard of it: {words.listing(left)}." if left else ""


def _ranking(found: Diagnosed) -> str:
    fitted = [each for each in found.document["candidates"] if each["penalised"] is not None]
    if len(fitted) < 2:
        return "Only one model could be fitted."
    first, second = fitted[:2]
    return (
        f"Best: {words.together(first['effects'])}. Next: {words.together(second['effects'])}, behind by "
        f"{digits.number(second['penalised'] - first['penalised'])}. Filled marks leave noise only."
    )


def _row(each: dict[str, Any], best: float | None) -> list[object]:
    behind = None if each["penalised"] is None or best is None else each["penalised"] - best
    numbers = "; ".join(words.compact(_own(key, each), value) for key, value in each["parameters"].items())
    left = [digits.number(each["q"], 4), each["dof"], words.probability(each["p"]), digits.number(behind)]
    return [_name(each), numbers or digits.NONE, each["status"], *left, *_score(each)]


def _own(key: str, each: dict[str, Any]) -> str:
    """Key of a number without its effect where there is only one effect."""
    effect, own = key.split(".", 1)
    return own if len(each["effects"]) == 1 else f"{effect} {own}"


def _name(each: dict[str, Any]) -> str:
    families = dict.fromkeys(EFFECTS[name].family for name in each["effects"] if name in EFFECTS)
    return words.together(each["effects"]) + (f" ({', '.join(families)})" if families else "")


def _score(each: dict[str, Any]) -> list[str]:
    return [
        digits.number(each["score"]),
        digits.NONE if each["retention"] is None else digits.percent(each["retention"]),
    ]
