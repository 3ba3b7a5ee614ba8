"""Figures inside the page: SVG in the text itself, with words for those who do not see it."""

import re
from base64 import b64encode
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

from wedgesweep import figures
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import diagnosis, forked
from wedgesweep.report import html
from wedgesweep.report.html import Markup

PIXELS_PER_INCH = 96  # of CSS


class Picture(NamedTuple):
    """A figure of some tests, or of those that it chooses itself, with its caption."""

    kind: str
    words: str
    tests: Sequence[int] | None


class Pictures:
    """Keeps places for the figures of one diagnosis in its page, and draws all of them at the end."""

    def __init__(self, found: Diagnosed) -> None:
        self.found = found
        self.wanted: list[Picture] = []

    def __call__(self, kind: str, words: str, tests: Sequence[int] | None = None) -> Markup:
        """The place of a figure."""
        self.wanted.append(Picture(kind, words, tests))
        return Markup(f"<!-- figure {len(self.wanted) - 1} -->")

    def fill(self, page: Markup, n_jobs: int) -> Markup:
        """The page with its figures in their places."""
        modules = diagnosis.FIGURES
        wanted = [(modules[picture.kind].draw, picture) for picture in self.wanted]
        drawn = forked.each(partial(_draw, self.found), wanted, n_jobs)
        return Markup(re.sub("<!-- figure ([0-9]+) -->", lambda place: drawn[int(place[1])], page))


def _draw(found: Diagnosed, wanted: tuple[Callable, Picture]) -> Markup:
    """A figure with its caption; what the tests cannot fill becomes a sentence that says why."""
    draw, picture = wanted
    options = {} if picture.tests is None else {"tests": picture.tests}
    try:
        figure = draw(found, **options)
    except ValueError as error:
        return html.paragraph(f"No figure: {error}.", class_="note")
    width, height = (round(PIXELS_PER_INCH * side) for side in figure.get_size_inches())
    alternative = f"{diagnosis.DESCRIPTIONS[picture.kind].capitalize()}. {picture.words}"
    address = "data:image/svg+xml;base64," + b64encode(figures.svg(figure)).decode("ascii")
    # With its size the page does not jump while it opens.
    image = html.image(src=address, width=width, height=height, alt=alternative)
    return html.element("figure", image, html.element("figcaption", picture.words))
