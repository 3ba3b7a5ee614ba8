"""What these tests can show, what they cannot, and what to measure next."""

from wedgesweep import digits
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.report import html, words
from wedgesweep.report.html import Markup


def limits(found: Diagnosed) -> Markup:
    """Section on what would have shown and what cannot."""
    rows = [
        [effect, name, words.with_unit(_weakest(name, value), unit)]
        for effect, weakest in found.document["detectable"].items()
        for (name, unit), value in [(words.split_key(key), value) for key, value in weakest.items()]
    ]
    caption = "Weakest effect that these tests would have shown"
    table = html.table(caption, ("effect", "number", "weakest value"), rows, 2)
    hidden = found.document["not_testable"]
    return html.section(
        "limits",
        "What these tests can show",
        table if rows else html.paragraph("No effect can be shown by these tests."),
        html.paragraph(_hidden(hidden)),
    )


def _weakest(name: str, value: float | None) -> str:
    """A number to two digits; of a factor those of its distance from 1."""
    if name != "scale" or value is None or value == 1.0:
        return digits.short(value, 2)
    return digits.fixed(value, digits.decimals(value - 1.0, 2))


def _hidden(effects: list[str]) -> str:
    if not effects:
        return "There is no candidate that these tests cannot show at all."
    return (
        f"Not testable: {words.listing(effects)}. What they would change of these tests, start phases, "
        "amplitudes and uncertain numbers may change as well. The verdict says nothing about them."
    )


def rivals(found: Diagnosed) -> Markup:
    """Section on explanations that the data cannot tell from the first."""
    rows = [
        [
            words.together(each["effects"]),
            "; ".join(map(words.meaning, each["effects"])),
            digits.number(each["gap"], 2),
        ]
        for each in found.document["rivals"]
    ]
    title = "Other explanations that will do" if found.document["causes"] else "Explanations that will do"
    told = (
        html.table(title, ("explanation", "meaning", "behind by"), rows, 2)
        if rows
        else html.paragraph(_alone(found))
    )
    return html.section("rivals", "Rivals", told)


def _alone(found: Diagnosed) -> str:
    if not found.document["causes"]:
        return "No cause is named, so nothing rivals it."
    return "No other explanation comes close enough to the best one to be confused with it."


def following(found: Diagnosed) -> Markup:
    """Section on the test to make next."""
    test = found.document["next_test"]
    if test is None:
        told: Markup | str = NOTHING_TO_MEASURE[found.verdict]
    else:
        (one, other), enough = test["separates"], found.document["method"]["enough_distance"]
        would, best = (
            (f"would tell {one} from {other}", "It is the cheapest one that does.")
            if words.tells(found.document)
            else (f"would not tell {one} from {other} for sure", "No test within reach tells more.")
        )
        told = html.join(
            [
                "A test at ",
                html.element("strong", words.following(test)),
                f" input amplitude {would}: their responses there are {digits.number(test['distance'])} "
                f"apart (squared, over noise; {digits.number(enough)} is enough). {best}",
            ],
            "",
        )
    return html.section("next", "What to measure next", html.paragraph(told))


NOTHING_TO_MEASURE = {
    "nothing-missing": "Nothing needs to be measured: the model explains these tests.",
    "named": "No further test is needed to name the cause.",
    "consistent-with": "There is no rival that a test would separate; more periods or larger inputs would "
    "make the evidence stronger, or show what else is wrong.",
    "tied": "No test within reach of the bench tells the tied explanations apart.",
    "data-insufficient": "No single test was found that would tell the candidates apart.",
    "none-of-mine": "No test can name an effect that is not among the candidates; the leftover force above "
    "shows what is missing.",
}
