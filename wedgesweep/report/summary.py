"""The first lines of the page: what is missing in plain words, and the numbers that show it."""

from collections.abc import Sequence

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.report import html, ladder, next_test, phrases
from wedgesweep.report.html import Markup

HEAD = ("", "in units of the noise", "of the response")


def lead(result: DiagnosisResult) -> str:
    """What is missing, in plain words."""
    causes = phrases.listing(
        [phrases.meaning(each["effect"], result.document) for each in result.document["causes"]]
    )
    match result.verdict:
        case "nothing-missing":
            return "The model misses nothing that these tests show."
        case "named":
            return f"The model misses {causes}."
        case "consistent-with":
            return f"The model probably misses {causes}; the evidence is weak."
        case "tied":
            rivals = [
                phrases.listing([phrases.meaning(effect, result.document) for effect in each["effects"]])
                for each in result.document["rivals"]
            ]
            return (
                f"The model misses {phrases.listing([causes, *rivals], 'or')}; these tests cannot tell which."
            )
        case "data-insufficient":
            tests = "this test" if result.data.sizes["test"] == 1 else "these tests"
            return f"The model misses something, and {tests} cannot show what."
        case _:
            return "The model misses something that is none of the known effects."


def table(result: DiagnosisResult) -> Markup:
    """Error before and after, gain on held-out tests, and the next step."""
    rows = [["error of the model", _times_noise(result, "base"), _accuracy(result, ())]]
    if result.added:
        extended = f"error with {phrases.combination(result.added)}"
        rows.append([extended, _times_noise(result, "extended"), _accuracy(result, result.added)])
    return html.join([html.table("Error before and after", HEAD, rows), html.items(_facts(result))])


def _facts(result: DiagnosisResult) -> list[str]:
    gain, test = result.gain, result.document["next_test"]
    facts = []
    if gain is not None:
        removed = formatting.percent(gain["excess_removed"])
        facts.append(
            f"On held-out tests {removed} of the excess over noise is gone ({phrases.interval(gain)})."
        )
    step = next_test.NOTHING_TO_MEASURE[result.verdict]
    facts.append(f"Next step: {step if test is None else f'a test at {phrases.next_test(test)}.'}")
    return facts


def _times_noise(result: DiagnosisResult, model: str) -> str:
    misfit = result.document["misfit"]
    return phrases.times_noise(misfit[f"chi2_{model}"], misfit.get(f"dof_{model}", misfit["dof"]))


def _accuracy(result: DiagnosisResult, effects: Sequence[str]) -> str:
    """Accuracy of an explanation on the ladder, as a share of the response."""
    for rung in ladder.rungs_of(result):
        if set(rung["effects"]) == set(effects):
            return phrases.accuracy(rung["accuracy"])
    return formatting.NONE
