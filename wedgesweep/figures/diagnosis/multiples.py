"""Small multiples: the same few panels for each test, one above the other."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import selection
from wedgesweep.figures.panels import Panels, Size, Target, panels

COLUMNS = 3
# Inches around the panels: title and legend of the figure, labels, titles of the tests.
TOP, BOTTOM, LEFT, BESIDE, TITLE, BELOW = 0.62, 0.36, 0.72, 0.6, 0.42, 0.46


@dataclass(frozen=True)
class Multiples(Panels):
    """The panels of a figure, ``parts`` of them for each test."""

    tests: Sequence[int] = ()
    parts: int = 1

    def __iter__(self) -> Iterator[tuple[int, list[Axes]]]:
        """Go through the tests with their panels, from above."""
        for place, test in enumerate(self.tests):
            yield test, self.axes[place * self.parts : (place + 1) * self.parts]

    def label_sides(self, *texts: str) -> None:
        """Label the y axes of the leftmost panels, from above."""
        for place, (_, axes) in enumerate(self):
            for ax, text in zip(axes, texts, strict=True):
                ax.set_ylabel(text, fontsize=8.5, visible=place % COLUMNS == 0)


def multiples(
    target: Target,
    result: DiagnosisResult,
    tests: Sequence[int] | None,
    size: Size,
    parts: int = 1,
    between: float = 0.0,
) -> Multiples:
    """Make ``parts`` panels per test; a new figure gives them a size and a gap in inches.

    The tests are by default those with the largest misfit.
    """
    chosen = selection.choose(result, tests)
    if isinstance(target, Axes):
        grid = panels(target, parts * len(chosen))
    else:
        grid = _grid(len(chosen), size, parts, between)
    made = Multiples(grid.figure, grid.axes, grid.embedded, chosen.tolist(), parts)
    for test, (first, *_) in made:
        first.set_title(
            f"{selection.label(result.data, test)}\n{selection.misfit_label(result, test)}", fontsize=8.5
        )
    return made


def _grid(count: int, size: Size, parts: int, between: float) -> Panels:
    """Give everything a fixed place: a layout by measuring would take longer than the drawing itself."""
    columns = min(COLUMNS, count)
    rows = -(-count // columns)
    cell = parts * size[1] + (parts - 1) * between
    across = columns * size[0] + (columns - 1) * BESIDE
    width = max(LEFT + across + BESIDE, 6.0)
    height = TOP + rows * (TITLE + cell + BELOW) + BOTTOM
    figure = Figure(figsize=(width, height))
    grid = figure.add_gridspec(
        rows,
        columns,
        left=LEFT / width,
        right=(LEFT + across) / width,
        top=1.0 - (TOP + TITLE) / height,
        bottom=(BOTTOM + BELOW) / height,
        wspace=BESIDE / size[0],
        hspace=(BELOW + TITLE) / cell,
    )
    axes = []
    for place in range(count):
        inner = grid[place // columns, place % columns].subgridspec(parts, 1, hspace=between / size[1])
        axes += [figure.add_subplot(inner[part]) for part in range(parts)]
    for ax in axes:
        style.dress(ax)
        ax.tick_params(labelsize=7.5)
    return Panels(figure, axes)
