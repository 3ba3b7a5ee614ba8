"""The page that a person reads: the answer first, then why, and what to do next."""

from importlib.resources import files
from string import Template

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.report import candidates, extension, held_out, html, method, outlook, wrong
from wedgesweep.report.html import Markup
from wedgesweep.report.pictures import Pictures
from wedgesweep.report.sentence import sentence

MEANINGS = {
    "nothing-missing": "the misfit is noise",
    "named": "a cause is named",
    "consistent-with": "named, but on weak evidence",
    "tied": "two or more explanations fit as well",
    "data-insufficient": "something is wrong, and these tests cannot show what",
    "none-of-mine": "something is wrong, and no candidate explains it",
}
CONTENTS = {
    "candidates": "Candidates",
    "model": "Extended model",
    "gain": "Gain",
    "limits": "What can be shown",
    "rivals": "Rivals",
    "next": "Next test",
    "method": "Method",
}


def render(found: Diagnosed, n_jobs: int = 1) -> str:
    """HTML of the whole page, drawn by ``n_jobs`` processes; it needs no other file."""
    draw = Pictures(found)
    content = html.join(
        [
            _answer(found),
            _contents(found),
            wrong.section(found, draw),
            candidates.section(found, draw),
            extension.section(found),
            held_out.section(found, draw),
            outlook.limits(found),
            outlook.rivals(found),
            outlook.following(found),
            method.section(found),
        ]
    )
    return Template(_read("page.html")).substitute(
        title=html.text(f"Diagnosis of {found.document['title']}"),
        style=_read("style.css"),
        content=draw.fill(content, n_jobs),
    )


def _answer(found: Diagnosed) -> Markup:
    verdict = html.join(
        ["Verdict: ", html.element("strong", found.verdict), f" ({MEANINGS[found.verdict]})"], ""
    )
    return html.element(
        "div",
        html.paragraph(sentence(found), class_="sentence"),
        html.paragraph(verdict, class_="verdict"),
        class_="answer",
    )


def _contents(found: Diagnosed) -> Markup:
    headings = {"wrong": wrong.heading(found), **CONTENTS}
    links = (html.element("a", text, href=f"#{name}") for name, text in headings.items())
    return html.element("nav", html.items(links), aria_label="Contents")


def _read(name: str) -> str:
    return (files("wedgesweep.report") / name).read_text(encoding="utf-8")
