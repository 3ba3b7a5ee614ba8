"""The test to make next."""

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup


def section(result: DiagnosisResult) -> Markup:
    """Section with the recommended test, or the reason why there is none."""
    test = result.document["next_test"]
    content = html.paragraph(nothing_to_measure(result)) if test is None else _recommended(result)
    return html.section("next", "What to measure next", content)


def nothing_to_measure(result: DiagnosisResult) -> str:
    """Why no test is recommended."""
    if any(each["step"] == "next test" for each in result.document.get("unfinished", [])):
        return "The diagnosis ended before it looked for the next test."
    return NOTHING_TO_MEASURE[result.verdict]


def _recommended(result: DiagnosisResult) -> Markup:
    test, enough = result.document["next_test"], result.document["method"]["enough_distance"]
    found = phrases.separated(result.document)
    if found is None:
        would = f"would not reliably distinguish {' from '.join(test['separates'])}"
        best = "No test within reach does better."
    else:
        would, best = f"would distinguish {found.text}", "It is the cheapest test that does."
    rows = [
        [" from ".join(each["separates"]), formatting.number(each["distance"])]
        for each in test.get("pairs", [test])
    ]
    caption = f"Squared distance of the predicted responses over the noise; {enough:g} is enough"
    table = html.table(caption, ("this test would distinguish", "distance"), rows)
    return html.join([_instruction(result, would, best), table])


def _instruction(result: DiagnosisResult, would: str, best: str) -> Markup:
    """The test in words: of a steady one its place, of others what to do."""
    test = result.document["next_test"]
    kind = test.get("kind", "steady")
    if kind == "steady":
        place = phrases.next_test(test).removeprefix("a test at ")
        return html.paragraph("A test at ", html.element("strong", place), f" {would}. {best}")
    order = html.element("strong", phrases.instruction(test))
    written = (
        ""
        if result.document.get("kind", "steady") in (kind, "mixed")
        else f' In measured.toml it has kind = "{kind}".'
    )
    return html.paragraph(order, f": this {would}. {best}{written}")


NOTHING_TO_MEASURE = {
    "nothing-missing": "Nothing needs to be measured: the model explains these tests.",
    "named": "No further test is needed to name the cause.",
    "consistent-with": "There is no rival that a test could rule out. More periods or larger inputs would "
    "strengthen the evidence, or show what else is wrong.",
    "tied": "No test within reach of the bench distinguishes the tied explanations.",
    "data-insufficient": "No single test was found that would distinguish the candidates.",
    "none-of-mine": "No test can name an effect that is not among the candidates; the figures show what "
    "the models leave. If an error of that size is acceptable, declare it as model_error.",
}
