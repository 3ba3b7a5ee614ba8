"""The first lines of the page: what is missing in plain words, and the numbers that show it."""

from collections.abc import Mapping, Sequence
from typing import Any

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult, Reason
from wedgesweep.report import html, ladder, next_test, phrases
from wedgesweep.report.html import Markup, Spanning


def lead(result: DiagnosisResult) -> str:
    """What is missing, in plain words."""
    causes = phrases.meanings([each["effect"] for each in result.document["causes"]], result.document)
    match result.verdict:
        case "nothing-missing":
            return "The model misses nothing that these tests show."
        case "named":
            return f"Missing or wrong in the model: {causes}."
        case "consistent-with" if result.reason is Reason.MORE_ACCURATE:
            why = result.document["reason"]
            them = "it" if len(result.document["causes"]) == 1 else "them"
            left = f"with {them} {phrases.accuracy(why['accuracy'])} of the response is left"
            if larger := why.get("larger"):
                least = min(each["accuracy"] for each in larger)
                left += f", and with another effect {phrases.accuracy(least)}"
            return f"Probably missing or wrong in the model: {causes}; {left}."
        case "consistent-with":
            return f"Probably missing or wrong in the model: {causes}; the evidence is weak."
        case "tied":
            rivals = [
                phrases.meanings(each["effects"], result.document) for each in result.document["rivals"]
            ]
            either = phrases.listing([causes, *rivals], "or")
            return (
                f"Missing or wrong in the model: {either}; {phrases.these_tests(result)} cannot tell which."
            )
        case "data-insufficient" if result.reason is Reason.NO_SIGNAL:
            return f"{phrases.these_tests(result).capitalize()} show hardly any response."
        case "data-insufficient" if result.reason is Reason.UNSEARCHED:
            return "Nothing may be missing, but the diagnosis ended before all effects were tried."
        case "data-insufficient" if result.reason is Reason.UNCHECKED:
            return "The model misses something, and the diagnosis ended before all causes were tried."
        case "data-insufficient":
            return f"The model misses something, and {phrases.these_tests(result)} cannot show what."
        case _:
            return "The model misses something that is none of the known effects."


def table(result: DiagnosisResult) -> Markup:
    """Error before and after, gain on held-out tests, what nearly explains the tests, and the next step."""
    models = result.models
    head = ("", "before", "after" if result.document["causes"] else "best attempt")[: 1 + len(models)]
    allowed = phrases.allowed(result.document)
    rows: list[Sequence[object]] = [
        [f"error, times the {allowed}", *(phrases.error_of(result, model) for model in models)],
        ["error, share of the response", *_accuracies(result)],
    ]
    gain, test = result.gain, result.document["next_test"]
    if gain is not None:
        errors = [formatting.number(gain[f"rmse_{model}"]) for model in models]
        rows.append([f"error on held-out tests, times the {allowed}", *errors])
        removed = phrases.excess_removed(gain, result.document, " is gone")
        rows.append(["gain on held-out tests", Spanning(removed)])
    if result.verdict == "none-of-mine":
        rows += [_nearly(level, result) for level in ladder.noteworthy(result)]
    step = next_test.nothing_to_measure(result)
    rows.append(["next step", Spanning(step if test is None else phrases.next_test(test))])
    return html.table("Error of the model", head, rows)


def _nearly(level: Mapping[str, Any], result: DiagnosisResult) -> Sequence[object]:
    """What explains the tests to some share of the response, though not to the noise."""
    meanings = phrases.meanings(level["effects"], result.document)
    to = phrases.accuracy(level["accuracy"]) if level["accuracy"] else "within the noise"
    cause = f"{meanings} ({phrases.combination(level['effects'])})"
    return [f"explains all tests to {to}", Spanning(cause)]


def _accuracies(result: DiagnosisResult) -> list[str]:
    shown: list[Sequence[str]] = [(), result.added] if result.added else [()]
    return [_accuracy(result, effects) for effects in shown]


def _accuracy(result: DiagnosisResult, effects: Sequence[str]) -> str:
    """Accuracy of an explanation on the ladder, as a share of the response."""
    for level in ladder.levels_of(result):
        if set(level["effects"]) == set(effects):
            size = phrases.accuracy(level["accuracy"])
            return "within the noise" if size == phrases.NOISE else size
    return formatting.NONE
