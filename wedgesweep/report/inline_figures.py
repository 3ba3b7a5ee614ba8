"""Figures inside the page, as SVG in its text, each with a caption and an alternative text.

A tap on one fills the window with it: the link leads to the figure itself, and the style sheet shows the
target of a link large. The link to close it leads to the place where it was.
"""

import re
from base64 import b64encode
from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

from wedgesweep import figures
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import diagnosis, parallel
from wedgesweep.report import html
from wedgesweep.report.html import Markup

PIXELS_PER_INCH = 96  # of CSS


class Wanted(NamedTuple):
    """A figure with its caption, of some tests (of a kind) or of those that it chooses itself."""

    name: str
    caption: str
    tests: Sequence[int] | None
    kind: str | None


class InlineFigures:
    """Keeps places for the figures of a diagnosis in its page, and draws all of them at the end."""

    def __init__(self, result: DiagnosisResult) -> None:
        self.result = result
        self.kind: str | None = None
        self.wanted: list[Wanted] = []

    def of_kind(self, kind: str) -> "InlineFigures":
        """The same page for figures of tests of one kind."""
        found = InlineFigures(self.result)
        found.kind, found.wanted = kind, self.wanted
        return found

    def __call__(self, name: str, caption: str = "", tests: Sequence[int] | None = None) -> Markup:
        """Keep the place of a figure; by default its caption is what there is to see in it."""
        self.wanted.append(Wanted(name, caption or diagnosis.FIGURES[name].reading, tests, self.kind))
        return Markup(f"<!-- figure {len(self.wanted) - 1} -->")

    def fill(self, page: Markup, n_jobs: int) -> Markup:
        """Return the page with its figures in their places, drawn by ``n_jobs`` processes."""
        numbered = list(enumerate(self.wanted))
        drawn = parallel.map_forked(partial(_draw, self.result), numbered, n_jobs)
        return Markup(re.sub("<!-- figure ([0-9]+) -->", lambda place: drawn[int(place[1])], page))


def _draw(result: DiagnosisResult, numbered: tuple[int, Wanted]) -> Markup:
    """Draw a figure with its caption; if the tests lack something for it, a sentence says what."""
    place, wanted = numbered
    picks: dict[str, Any] = {} if wanted.tests is None else {"tests": wanted.tests}
    try:
        shown = result if wanted.kind is None else result.of_kind(wanted.kind)
        figure = figures.draw(shown, wanted.name, **picks)
    except ValueError as error:
        return html.paragraph(f"No figure ({error}).", class_="note")
    width, height = (round(PIXELS_PER_INCH * side) for side in figure.get_size_inches())
    alternative = f"{diagnosis.FIGURES[wanted.name].description.capitalize()}. {wanted.caption}"
    address = "data:image/svg+xml;base64," + b64encode(figures.svg(figure)).decode("ascii")
    # Its size keeps the page from jumping while it opens.
    image = html.image(src=address, width=width, height=height, alt=alternative)
    return _opening(place, image, width, wanted.caption)


def _opening(place: int, image: Markup, width: int, caption: str) -> Markup:
    """A figure that opens large, and closes again."""
    large, here = f"figure-{place}", f"at-figure-{place}"
    figure = html.element(
        "figure",
        html.element("a", image, href=f"#{large}", class_="open", title="Open large"),
        html.element("figcaption", caption),
        html.element("a", "Close", href=f"#{here}", class_="close"),
        id=large,
        style=f"--width: {width}px",
    )
    return html.element("div", figure, id=here)
