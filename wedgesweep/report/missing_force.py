"""The force that no name explains: its shape, its gain, and what it looks like."""

from typing import Any

from wedgesweep import formatting
from wedgesweep.diagnosis_result import FORCE_CONFIG, FORCE_TABLE, DiagnosisResult
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup
from wedgesweep.report.inline_figures import InlineFigures

HEAD = ("form", "share explained", "95 % interval")
NAMED = "Known forms fitted to this force: hypotheses to test, not a verdict"
MOST = 6  # rows


def section(result: DiagnosisResult, draw: InlineFigures) -> Markup:
    """Section with the empirical force; nothing where none was fitted."""
    force = result.document.get("empirical_force")
    if not force:
        return Markup()
    content: list[Markup] = [html.paragraph(_gain(force))]
    if force["offered"]:
        content += [draw("missing-force"), _nearest(force), html.paragraph(_further(force))]
    return html.section("force", "The missing force", *content)


def _gain(force: dict[str, Any]) -> str:
    """How well the force predicts, beside the best named explanation."""
    named = force["named"]
    who = phrases.listing(named["effects"]) if named["effects"] else "the base model"
    both = (
        f"As a table of displacement and velocity ({force['degrees_of_freedom']:.0f} degrees of freedom, "
        f"chosen by tests left out) the missing force leaves {_percent(force['accuracy'])} of the response, "
        f"and {_percent(force['accuracy_held_out'])} on tests left out. The best named explanation "
        f"there ({who}) leaves {_percent(named['accuracy'])} and {_percent(named['accuracy_held_out'])}."
    )
    if force["offered"]:
        return both
    return f"{both} It predicts no better than what has a name, so that it is not shown."


def _nearest(force: dict[str, Any]) -> Markup:
    rows = [
        [
            each["form"],
            formatting.percent(each["share"]),
            " to ".join(formatting.percent(end) for end in each["ci95"]),
        ]
        for each in force["nearest"][:MOST]
    ]
    if not rows:
        return html.paragraph("It looks like none of the known forms.")
    return html.table(NAMED, HEAD, rows, 1)


def _further(force: dict[str, Any]) -> str:
    place = " and ".join(phrases.size(force["next_place"], key) for key in force["next_place"])
    step = next(key for key in force if key.startswith("step_"))
    differs = "The friction at rest differs from the base model's by"
    friction = "" if force[step] is None else f"{differs} {phrases.size(force, step)}. "
    return (
        f"{friction}A further test would show most at {place}, where the "
        f"force is known least. {FORCE_CONFIG} is the base model with this force ({FORCE_TABLE}), an "
        "ordinary config."
    )


def _percent(share: float | None) -> str:
    return "more than the response" if share is None else formatting.percent(share)
