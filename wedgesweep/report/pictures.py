"""Figures inside the page: SVG in the text itself, with words for those who do not see it."""

from base64 import b64encode
from collections.abc import Sequence
from types import ModuleType

from wedgesweep import figures
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import diagnosis
from wedgesweep.report import html
from wedgesweep.report.html import Markup

PIXELS_PER_INCH = 96  # of CSS


class Pictures:
    """Draws the figures of one diagnosis into its page, loading matplotlib once."""

    def __init__(self, found: Diagnosed) -> None:
        self.found = found
        self.modules: dict[str, ModuleType] = diagnosis.FIGURES

    def __call__(self, kind: str, words: str, tests: Sequence[int] | None = None) -> Markup:
        """A figure with its caption; what the tests cannot fill becomes a sentence that says why."""
        options = {} if tests is None else {"tests": tests}
        try:
            figure = self.modules[kind].draw(self.found, **options)
        except ValueError as error:
            return html.paragraph(f"No figure: {error}.", class_="note")
        width, height = (round(PIXELS_PER_INCH * side) for side in figure.get_size_inches())
        alternative = f"{diagnosis.DESCRIPTIONS[kind].capitalize()}. {words}"
        address = "data:image/svg+xml;base64," + b64encode(figures.svg(figure)).decode("ascii")
        # With its size the page does not jump while it opens.
        image = html.image(src=address, width=width, height=height, alt=alternative)
        return html.element("figure", image, html.element("figcaption", words))
