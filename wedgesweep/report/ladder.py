"""The accuracy ladder: how well no effect, one, two and more explain the tests, as shares of the response."""

from collections.abc import Mapping, Sequence
from itertools import starmap
from typing import Any

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup
from wedgesweep.report.inline_figures import InlineFigures

HEAD = ("effects", "explanation", "accuracy", "on held-out tests", "next best", "its accuracy")
# A pair is mentioned beside its better component if it is MUCH_BETTER times as accurate.
MUCH_BETTER = 2.0
READING = (
    "The accuracy is the smallest error of the model, as a share of the rms of the response, with which the "
    "explanation is adequate (p ≥ 0.01): 1 % means that it explains all tests to 1 % of the response. An "
    "explanation with “noise” needs no such error. On held-out tests it is the accuracy of predictions by "
    "fits to the other tests. What lies below the noise floor is not resolved."
)


def section(result: DiagnosisResult, draw: InlineFigures) -> Markup:
    """Section with the figure and a table of the best explanations of each size."""
    levels = levels_of(result)
    if not levels:
        return Markup()
    rows = [_row(level) for level in levels]
    floor = result.document["method"].get("noise_floor")
    return html.section(
        "accuracy",
        "Accuracy",
        html.paragraph(" ".join([*(f"{one[0].upper()}{one[1:]}." for one in clauses(result)), READING])),
        draw("ladder"),
        html.table("The most accurate explanations", HEAD, rows, 2),
        html.paragraph(f"{said[0].upper()}{said[1:]}.") if (said := parts(result)) else Markup(),
        _added(levels[3:]),
        _record_by_record(result),
        html.paragraph(f"Noise floor: {phrases.accuracy(floor)}.") if floor else Markup(),
    )


def parts(result: DiagnosisResult) -> str:
    """What of the error is noise, what differs between repeats, and what is left to models; or empty."""
    repeats, levels = result.document.get("repeats"), levels_of(result)
    if not repeats or not levels:
        return ""
    low, high = map(formatting.error, repeats["ci95"])
    floor = phrases.accuracy(result.document["method"].get("noise_floor"))
    if not repeats["ci95"][0]:
        return f"repeats of a test differ by no more than noise (by less than {high} of the response)"
    if not repeats["counts"]:
        return (
            f"tests alike differ by {formatting.error(repeats['share'])} of the response; state what differs "
            "(temperature_C, or numbers of the model) in each of them"
        )
    left = [
        f"{phrases.combination(level['effects'])} {formatting.error(level['model_share'])}"
        for level in levels
        if level.get("model_share") is not None
    ]
    return (
        f"of the error, noise makes {floor} of the response, what differs between repeats of a test "
        f"{formatting.error(repeats['share'])} (95 % interval {low} to {high}), and the rest is left to the "
        f"model ({', '.join(left)}); no cause is to explain what differs between repeats"
    )


def _added(further: Sequence[Mapping[str, Any]]) -> Markup:
    """Effects beyond two, with what each gains on tests left out."""
    if not further:
        return Markup()
    steps = [f"{level['effects'][-1]} ({held_out(level)})" for level in further]
    said = f"Added to the best pair one at a time, as long as tests left out gain: {', then '.join(steps)}."
    return html.paragraph(f"{said} More than two effects are never named.")


def _record_by_record(result: DiagnosisResult) -> Markup:
    """The numbers of explanations that differ from record to record."""
    by_record = result.document.get("record_by_record", [])
    if not by_record:
        return Markup()
    head = ("record", *(phrases.combination(each["effects"]) for each in by_record))
    rows = [
        [own[0]["record"], *("; ".join(starmap(phrases.compact, one["parameters"].items())) for one in own)]
        for own in zip(*(each["records"] for each in by_record), strict=True)
    ]
    return html.table("Fitted to each record by itself (95 % intervals)", head, rows, 0)


def _row(level: Mapping[str, Any]) -> list[str]:
    rival = next(iter(level["rivals"]), None)
    return [
        str(len(level["effects"])),
        phrases.combination(level["effects"]),
        phrases.accuracy(level["accuracy"]),
        phrases.accuracy(level.get("accuracy_held_out")),
        phrases.combination(rival["effects"]) if rival else formatting.NONE,
        phrases.accuracy(rival["accuracy"]) if rival else formatting.NONE,
    ]


def levels_of(result: DiagnosisResult) -> Sequence[Mapping[str, Any]]:
    """The levels of the ladder, the base model's first; empty in results of older versions."""
    return result.document.get("ladder", [])


def clauses(result: DiagnosisResult) -> list[str]:
    """What the best single effect explains, and the best pair where it is much better, as clauses."""
    levels = levels_of(result)
    found = [_clause(level, levels[0], result.document) for level in noteworthy(result)]
    by_record = result.document.get("record_by_record", [])
    return [*found, _of_records(by_record, result.document)] if by_record else found


def noteworthy(result: DiagnosisResult) -> list[Mapping[str, Any]]:
    """The level of the best single effect, and that of the best pair where it is much better.

    What leaves as much as there is of the response explains nothing.
    """
    levels = levels_of(result)
    if not levels:
        return []
    base, *better = levels
    found: list[Mapping[str, Any]] = []
    reached = base["accuracy"]
    for level in better:
        left = level["accuracy"]
        if left is None or left >= 1.0 or (found and left * MUCH_BETTER > (reached or 0.0)):
            continue
        found.append(level)
        reached = left
    return found


def held_out(level: Mapping[str, Any]) -> str:
    """How well an explanation predicts tests that it was not fitted to; empty if none were left out."""
    size = level.get("accuracy_held_out")
    return "" if size is None else f"held-out tests: {phrases.accuracy(size)}"


def _of_records(by_record: Sequence[Mapping[str, Any]], document: Mapping[str, Any]) -> str:
    """What the best explanation achieves with numbers of its own in each record, and the simplest one."""
    best, *others = by_record
    meaning = phrases.meanings(best["effects"], document)
    own = _numbers_of_records(best)
    told = f"what differs from record to record may be {meaning}: fitted to each by itself, {own}"
    simplest = min(by_record, key=lambda each: len(each["records"][0]["parameters"]))
    if simplest is not best:
        return f"{told}; with fewer numbers, {_numbers_of_records(simplest)}"
    return "; next best, ".join([told, *map(_numbers_of_records, others[:1])])


def _numbers_of_records(one: Mapping[str, Any]) -> str:
    keys = one["records"][0]["parameters"]
    numbers = [
        phrases.numbers(key, [each["parameters"][key]["value"] for each in one["records"]]) for key in keys
    ]
    return (
        f"{phrases.combination(one['effects'])} to {phrases.accuracy(one['accuracy'])} ({', '.join(numbers)})"
    )


def _clause(level: Mapping[str, Any], base: Mapping[str, Any], document: Mapping[str, Any]) -> str:
    meanings = phrases.meanings(level["effects"], document)
    verb = phrases.explain(level["effects"])
    beside = [f"without: {phrases.accuracy(base['accuracy'])}"]
    if predicted := held_out(level):
        beside.insert(0, predicted)
    for rival in level["rivals"][:1]:
        name = phrases.combination(rival["effects"])
        beside.append(f"next best, {name}: {phrases.accuracy(rival['accuracy'])}")
    size, names = level["accuracy"], phrases.combination(level["effects"])
    to = f"to {phrases.accuracy(size)} of the response" if size else "to within the noise"
    return f"{to}, {meanings} ({names}) {verb} all tests ({'; '.join(beside)})"
