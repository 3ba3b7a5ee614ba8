"""The test to make next."""

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup


def section(result: DiagnosisResult) -> Markup:
    """Section with the recommended test, or the reason why there is none."""
    test = result.document["next_test"]
    content = NOTHING_TO_MEASURE[result.verdict] if test is None else _recommended(result)
    return html.section("next", "What to measure next", html.paragraph(content))


def _recommended(result: DiagnosisResult) -> Markup:
    test, enough = result.document["next_test"], result.document["method"]["enough_distance"]
    would, best = (
        ("would distinguish", "It is the cheapest test that does.")
        if phrases.distinguishes(result.document)
        else ("would not reliably distinguish", "No test within reach does better.")
    )
    place = html.element("strong", phrases.next_test(test))
    outcome = (
        f" input amplitude {would} {' from '.join(test['separates'])}: the squared distance between their "
        f"responses is {formatting.number(test['distance'])} in units of the noise "
        f"({formatting.number(enough)} is enough). {best}"
    )
    return html.join(["A test at ", place, outcome], "")


NOTHING_TO_MEASURE = {
    "nothing-missing": "Nothing needs to be measured: the model explains these tests.",
    "named": "No further test is needed to name the cause.",
    "consistent-with": "There is no rival that a test could rule out. More periods or larger inputs would "
    "strengthen the evidence, or show what else is wrong.",
    "tied": "No test within reach of the bench distinguishes the tied explanations.",
    "data-insufficient": "No single test was found that would distinguish the candidates.",
    "none-of-mine": "No test can name an effect that is not among the candidates; the residual force above "
    "shows what is missing.",
}
