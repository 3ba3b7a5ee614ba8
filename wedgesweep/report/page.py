"""The page that a person reads: the answer first, then the evidence, and what to do next."""

from importlib.resources import files
from string import Template

from wedgesweep import rotation
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.report import (
    candidates,
    extension,
    held_out,
    html,
    ladder,
    limits,
    method,
    misfit,
    missing_force,
    next_test,
    phrases,
    sampled,
    summary,
)
from wedgesweep.report.html import Markup
from wedgesweep.report.inline_figures import InlineFigures
from wedgesweep.report.sentence import sentence

CONTENTS = {
    "candidates": "Candidates",
    "accuracy": "Accuracy",
    "model": "Extended model",
    "gain": "Gain",
    "force": "Missing force",
    "limits": "What can be shown",
    "rivals": "Rivals",
    "next": "Next test",
    "method": "Method",
}


def render(result: DiagnosisResult, n_jobs: int = 1) -> str:
    """Return the whole page as HTML that needs no other file; ``n_jobs`` processes draw its figures."""
    draw = InlineFigures(result)
    content = html.join(
        [
            _answer(result),
            _contents(result),
            _measured_and_simulated(result, draw),
            candidates.section(result, draw),
            ladder.section(result, draw),
            extension.section(result),
            held_out.section(result, draw),
            missing_force.section(result, draw),
            limits.section(result),
            candidates.rivals(result),
            next_test.section(result),
            method.section(result),
        ]
    )
    if phrases.turns(result.document):
        content = Markup(rotation.prose(content))
    return Template(_read("page.html")).substitute(
        title=html.text(f"Diagnosis of {result.document['title']}"),
        style=_read("style.css"),
        content=draw.fill(content, n_jobs),
    )


def _measured_and_simulated(result: DiagnosisResult, draw: InlineFigures) -> Markup:
    if result.parts:
        parts = [(kind, result.of_kind(kind), draw.of_kind(kind)) for kind in result.parts]
        places = ["misfit", *(f"misfit-{kind}" for kind, *_ in parts[1:])]
        return html.join(
            [_of_one_kind(its, own, place) for place, (_, its, own) in zip(places, parts, strict=True)]
        )
    return _of_one_kind(result, draw, "misfit")


def _of_one_kind(result: DiagnosisResult, draw: InlineFigures, place: str) -> Markup:
    if result.document.get("kind", "steady") != "steady":
        return sampled.section(result, draw, misfit.heading(result), place)
    return misfit.section(result, draw, place)


def _answer(result: DiagnosisResult) -> Markup:
    why = f" ({result.reason.value})" if result.reason else ""
    verdict = html.join(["Verdict: ", html.element("strong", result.verdict), why], "")
    return html.element(
        "div",
        html.paragraph(summary.lead(result), class_="lead"),
        summary.table(result),
        html.paragraph(sentence(result), class_="sentence"),
        html.paragraph(verdict, class_="verdict"),
        class_="answer",
    )


def _contents(result: DiagnosisResult) -> Markup:
    headings = {"misfit": misfit.heading(result), **CONTENTS}
    if not ladder.levels_of(result):
        del headings["accuracy"]
    if not result.document.get("empirical_force"):
        del headings["force"]
    links = (html.element("a", text, href=f"#{name}") for name, text in headings.items())
    return html.element("nav", html.items(links), aria_label="Contents")


def _read(name: str) -> str:
    return (files("wedgesweep.report") / name).read_text(encoding="utf-8")
