"""The panels of a figure, in a figure made for them, in one that is given, or in given axes."""

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import wrap
from typing import Any

import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure, SubFigure

from wedgesweep.figures import cases, style

CHARACTERS_PER_INCH = 13  # of a title or legend
HANDLE = 8  # characters that the mark of a label in a legend takes
TITLE_MARGIN = 0.08  # inches

# Where to draw; None stands for a new figure.
Target = Axes | None
Size = tuple[float, float]  # inches


@dataclass(frozen=True)
class Panels:
    """The panels of one figure, row by row; ``embedded`` if the only one was given by the caller."""

    figure: Figure | SubFigure
    axes: list[Axes]
    embedded: bool = False

    def title(self, what: str, *notes: str) -> None:
        """Write what the figure shows, and below it how to read it; empty notes are left out.

        Given axes keep the title of their panel; if they have none, it is what the figure shows.
        """
        if self.embedded:
            ax = self.axes[0]
            ax.set_title(ax.get_title() or self._wrapped(what, ax.bbox.width), fontsize=10)
            return
        note = "; ".join(filter(None, notes))
        lines = [self._wrapped(text, self.figure.bbox.width) for text in (what, note) if text]
        self._write(lines)

    def head(self, study: str) -> None:
        """Put the title of the sweep above what the figure shows; given axes do not show it."""
        if study and not self.embedded:
            shown = self.figure.get_suptitle()
            self._write([self._wrapped(study, self.figure.bbox.width), *([shown] if shown else [])])

    def _write(self, lines: Sequence[str]) -> None:
        # Where nothing lays the figure out, the title stays at the same distance from its upper edge.
        free = self.figure.get_layout_engine() is None
        height = self.figure.bbox.height / self.figure.dpi
        place: dict[str, Any] = {"y": 1.0 - TITLE_MARGIN / height, "va": "top"} if free else {}
        self.figure.suptitle("\n".join(lines), fontsize=10.5, linespacing=1.4, **place)

    def _wrapped(self, text: str, pixels: float) -> str:
        return "\n".join(wrap(text, max(20, int(CHARACTERS_PER_INCH * pixels / self.figure.dpi))))

    def legend(
        self, handles: Sequence[Artist] | None = None, labels: Sequence[str] = (), columns: int = 3
    ) -> None:
        """Write a legend below the panels, or into given axes; by default of the first panel.

        Handles without ``labels`` have their own.
        """
        handles = self.axes[0].get_legend_handles_labels()[0] if handles is None else handles
        labels = labels or [str(handle.get_label()) for handle in handles]
        if not handles:
            return
        if self.embedded:
            self.axes[0].legend(handles, labels, fontsize=8)
            return
        room = CHARACTERS_PER_INCH * self.figure.bbox.width / self.figure.dpi
        place: dict[str, Any] = {"loc": "outside lower center", "ncols": _fitting(labels, columns, room)}
        self.figure.legend(handles, labels, fontsize=8.5, frameon=False, **place)

    def colorbar(self, mappable: ScalarMappable, label: str, axes: Sequence[Axes] | None = None) -> Colorbar:
        """Add a colour bar to some panels, by default to all."""
        bar = self.figure.colorbar(mappable, ax=self.axes if axes is None else axes, aspect=30, pad=0.02)
        bar.ax.tick_params(labelsize=8)
        bar.set_label(label, fontsize=9)
        return bar


def panels(
    target: Target,
    count: int,
    *,
    columns: int = 3,
    size: Size = (3.4, 3.5),
    margin: Size = (0.8, 0.6),
    share: bool = True,
) -> Panels:
    """Make ``count`` panels; a new figure gives each the size in inches, with a margin around all.

    Raises
    ------
    ValueError
        The target is a single Axes, and there are more panels than one.
    """
    if isinstance(target, Axes):
        return _embedded(target, count)
    columns = min(columns, count)
    rows = -(-count // columns)
    width = max(columns * size[0] + margin[0], 5.2)
    figure = Figure(figsize=(width, rows * size[1] + margin[1]), layout="constrained")
    grid = figure.subplots(rows, columns, sharex=share, sharey=share, squeeze=False).ravel()
    for spare in grid[count:]:
        spare.remove()
    for ax in grid[:count]:
        style.dress(ax)
    return Panels(figure, list(grid[:count]))


def per_law(
    target: Target, ds: xr.Dataset, **options: Any
) -> tuple[Panels, list[tuple[Axes, str, xr.Dataset]]]:
    """Make a panel for each law, with its name as title (see ``panels``); axes, law and cases of each."""
    names = cases.laws(ds)
    made = panels(target, len(names), **options)
    for ax, law in zip(made.axes, names, strict=True):
        ax.set_title(law, fontsize=10)
    return made, [(ax, law, ds.sel(friction_law=law)) for ax, law in zip(made.axes, names, strict=True)]


def _fitting(labels: Sequence[str], most: int, room: float) -> int:
    """Columns of a legend, at most ``most``, whose longest labels fit side by side (characters)."""
    sizes = [len(label) + HANDLE for label in labels]
    for columns in range(min(most, len(sizes)), 1, -1):
        rows = -(-len(sizes) // columns)
        if sum(max(sizes[place : place + rows]) for place in range(0, len(sizes), rows)) <= room:
            return columns
    return 1


def _embedded(ax: Axes, count: int) -> Panels:
    if count > 1:
        raise ValueError(
            f"{count} panels do not fit into one Axes; give a figure, or data for a single panel"
        )
    style.dress(ax)
    return Panels(ax.figure, [ax], embedded=True)
