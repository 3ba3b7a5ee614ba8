"""Figures inside the page, as SVG in its text, each with a caption and an alternative text."""

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

    def __call__(self, name: str, caption: str, tests: Sequence[int] | None = None) -> Markup:
        """Keep the place of a figure."""
        self.wanted.append(Wanted(name, caption, tests, self.kind))
        return Markup(f"<!-- figure {len(self.wanted) - 1} -->")

    def fill(self, page: Markup, n_jobs: int) -> Markup:
        """Return the page with its figures in their places, drawn by ``n_jobs`` processes."""
        drawn = parallel.map_forked(partial(_draw, self.result), self.wanted, n_jobs)
        return Markup(re.sub("<!-- figure ([0-9]+) -->", lambda place: drawn[int(place[1])], page))


def _draw(result: DiagnosisResult, wanted: Wanted) -> Markup:
    """Draw a figure with its caption; if the tests lack something for it, a sentence says what."""
    picks: dict[str, Any] = {} if wanted.tests is None else {"tests": wanted.tests}
    try:
        shown = result if wanted.kind is None else result.of_kind(wanted.kind)
        figure = figures.draw(shown, wanted.name, **picks)
    except ValueError as error:
        return html.paragraph(f"No figure ({error}).", class_="note")
    width, height = (round(PIXELS_PER_INCH * side) for side in figure.get_size_inches())
    alternative = f"{diagnosis.DESCRIPTIONS[wanted.name].capitalize()}. {wanted.caption}"
    address = "data:image/svg+xml;base64," + b64encode(figures.svg(figure)).decode("ascii")
    # Its size keeps the page from jumping while it opens.
    image = html.image(src=address, width=width, height=height, alt=alternative)
    return html.element("figure", image, html.element("figcaption", wanted.caption))
