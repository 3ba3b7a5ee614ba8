"""A drawn figure in units of choice: axes keep their scale, and their ticks and all texts are converted."""

import re
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure, SubFigure
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator, Formatter, FuncFormatter, Locator, NullLocator, ScalarFormatter

from wedgesweep.units import in_text, unit_in

# The unit of an axis at the end of its label.
_OF_AXIS = re.compile(r"\[([^\[\]]+)\]")


class _Ticks(Locator):
    """Ticks that are round in a unit of some ``size``, which is that of the axis over that of its numbers."""

    def __init__(self, inner: Locator, size: float) -> None:
        self.inner, self.size = inner, size

    def __call__(self) -> Any:
        low, high = self.inner.axis.get_view_interval() if self.inner.axis else (0.0, 1.0)
        return self.tick_values(low, high)

    def tick_values(self, vmin: float, vmax: float) -> Any:
        return np.asarray(self.inner.tick_values(vmin / self.size, vmax / self.size)) * self.size

    def nonsingular(self, v0: float, v1: float) -> tuple[float, float]:
        return self.inner.nonsingular(v0, v1)

    def view_limits(self, vmin: float, vmax: float) -> tuple[float, float]:
        return self.inner.view_limits(vmin, vmax)


class _Numbers(Formatter):
    """Texts of such ticks."""

    def __init__(self, inner: Formatter, size: float) -> None:
        self.inner, self.size = inner, size

    def __call__(self, x: float, pos: int | None = None) -> str:
        if isinstance(self.inner, ScalarFormatter):  # which looks at the limits of the axis for an offset
            return f"{x / self.size:.6g}"
        return self.inner(x / self.size, pos)

    def set_locs(self, locs: Any) -> None:
        self.inner.set_locs(np.asarray(locs) / self.size)


def show_in(part: Figure | SubFigure | Axes, system: str) -> None:
    """Write ticks and texts of a figure, or of some axes, in one of units.SYSTEMS, in place."""
    whole = [part] if isinstance(part, Axes) else part.axes
    axes = [each for parent in whole for each in (parent, *parent.child_axes)]
    done: set[int] = set()
    for axis in (axis for ax in axes for axis in (ax.xaxis, ax.yaxis)):
        found = _OF_AXIS.search(axis.get_label_text())
        # Panels may share their ticks.
        if found and id(axis.major) not in done and (size := unit_in(found[1], system)[1]) != 1.0:
            done.add(id(axis.major))
            _rescale(axis, size)
    for text in part.findobj(Text):
        if isinstance(text, Text):
            text.set_text(in_text(text.get_text(), system))


def _rescale(axis: Axis, size: float) -> None:
    """Place and write the ticks of an axis in a unit of some size."""
    for ticker, set_locator, set_formatter in (
        (axis.major, axis.set_major_locator, axis.set_major_formatter),
        (axis.minor, axis.set_minor_locator, axis.set_minor_formatter),
    ):
        locator, formatter = ticker.locator, ticker.formatter
        if isinstance(locator, NullLocator):
            continue
        if isinstance(locator, FixedLocator):  # with texts that are the numbers
            set_formatter(FuncFormatter(partial(_divided_text, formatter, size)))
            continue
        set_locator(_Ticks(locator, size))
        set_formatter(_Numbers(formatter, size))


def _divided_text(formatter: Formatter, size: float, value: float, place: int | None) -> str:
    return f"{float(formatter(value, place)) / size:.3g}"
