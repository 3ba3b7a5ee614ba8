"""Explanations that the data cannot distinguish from the best one."""

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup


def section(result: DiagnosisResult) -> Markup:
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
        "rivals", "Rival explanations", table if rows else html.paragraph(NONE if named else NO_CAUSE)
    )


NONE = "No other explanation comes close enough to the best one to be confused with it."
NO_CAUSE = "No cause is named, so there are no rivals to it."
