"""Error before and after the extension, on tests that were held out of the fit."""

from typing import Any

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup
from wedgesweep.report.inline_figures import InlineFigures

HEAD = ("test", "left out", "error before", "error after", "noise floor")
CAPTION = "Each test is predicted by models fitted to the other tests. Errors are in units of the {allowed}."


def section(result: DiagnosisResult, draw: InlineFigures) -> Markup:
    """Section with the gain and its interval."""
    gain = result.gain
    if gain is None:
        content: tuple[Markup, ...] = (html.paragraph(_why_not(result)),)
    else:
        rows = [_row(result, each) for each in gain["held_out"]]
        content = (
            html.paragraph(_summary(result, gain)),
            draw("gain", CAPTION.format(allowed=phrases.allowed(result.document))),
            html.details("Table of the held-out tests", html.table("Held-out tests", HEAD, rows, 2)),
        )
    return html.section("gain", "Before and after, on held-out tests", *content)


def _why_not(result: DiagnosisResult) -> str:
    if not result.added:
        return "Nothing was added to the model, so there is no gain to measure."
    return "There are too few tests to hold one out."


def _summary(result: DiagnosisResult, gain: dict[str, Any]) -> str:
    before, after, floor = (formatting.number(gain[f"rmse_{kind}"]) for kind in ("base", "extended", "noise"))
    allowed = phrases.allowed(result.document)
    alone = "noise alone leaves" if allowed == "noise" else f"{allowed} leave"
    claim = "" if result.document["causes"] else " This is the best attempt; the verdict names no cause."
    return (
        f"Cross-validation ({gain['scheme']}): the error on held-out tests goes from {before} to {after} "
        f"times the {allowed}, a gain of {formatting.percent(gain['gain'])}; {alone} {floor}. The extension "
        f"removes {phrases.excess_removed(gain, result.document)}.{claim}"
    )


def _row(result: DiagnosisResult, each: dict[str, Any]) -> list[str]:
    errors = [formatting.number(each[f"rmse_{kind}"]) for kind in ("base", "extended", "noise")]
    test = result.data["test"].values[result.test_index(each["test"])]
    left_out = "this test" if each["scheme"] == "test" else f"all at its {each['scheme']}"
    return [str(test), left_out, *errors]
