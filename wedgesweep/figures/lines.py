"""Any number of the cases over one axis of the sweep, another axis as colour."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from wedgesweep.figures import over_axes, style, validity
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "lines"
DESCRIPTION = "a variable over any axis of the sweep (--x), --color and --facet for two others"
NEEDS = ("status",)
ANY_AXES = True

# A legend tells MOST_NAMED colours apart; more values have a colour bar.
MOST_NAMED = 6
# Marks of more cases would cover all lines; the title tells their share.
MOST_MARKED = 5000


def _draw_panel(
    ax: Axes, part: xr.Dataset, layout: over_axes.Layout, variable: str, colors: list[Any], names: list[str]
) -> None:
    x = over_axes.values(part, layout.x)
    others = [part]
    if layout.other:
        dim = part[layout.other].dims[0]
        others = [part.isel({dim: place}) for place in range(part.sizes[dim])]
    for case, color, name in zip(others, colors, names, strict=True):
        y = case[variable].values
        ax.plot(
            x, y, color=color, linewidth=1.2, marker="." if len(x) <= validity.FEW_POINTS else "", label=name
        )
        if part["status"].size <= MOST_MARKED:
            validity.mark(ax, x, y, case, color)
        style.mark_missing(ax, x[np.isnan(y)] if y.dtype.kind == "f" else x[:0], color)


def draw(
    target: Target,
    ds: xr.Dataset,
    x: str | None = None,
    color: str | None = None,
    facet: str | None = None,
    variable: str | None = None,
    at: Mapping[str, Any] | None = None,
) -> Panels:
    """Draw a variable over the axis ``x``; by default the longest."""
    ds, layout = over_axes.laid_out(ds, x, color, facet, at)
    variable = variable or over_axes.size_of_motion(ds)
    over_axes.variable_of(ds, variable)
    parts = over_axes.panels_of(ds, layout.facet)
    made = panels(target, len(parts), size=(3.3, 3.2))
    shades, names, bar = _colors(ds, layout.other)
    for ax, (title, part) in zip(made.axes, parts, strict=True):
        _draw_panel(ax, part, layout, variable, shades, names)
        ax.set_title(title, fontsize=10)
    style.label(made.axes, over_axes.label(ds, layout.x), over_axes.short(ds, variable))
    if bar is not None and layout.other:
        made.colorbar(bar, over_axes.label(ds, layout.other))
    handles = [] if bar is not None else made.axes[0].get_legend_handles_labels()[0]
    marks = validity.handles(ds) if parts[0][1]["status"].size <= MOST_MARKED else []
    made.legend([*(handles if layout.other else []), *marks])
    made.title(over_axes.meaning(ds, variable), over_axes.picked(ds, layout), validity.shares(ds))
    return made


def _colors(ds: xr.Dataset, name: str | None) -> tuple[list[Any], list[str], ScalarMappable | None]:
    """Colour and name of each value of an axis; what a colour bar shows if they are many."""
    if name is None:
        return [style.BLUE], [""], None
    found = over_axes.values(ds, name)
    names = [over_axes.written(ds, name, value) for value in ds[name].values.tolist()]
    if name == "friction_law":
        return [style.law_style(str(law))["color"] for law in found], names, None
    if len(found) <= MOST_NAMED:
        return list(style.SEQUENTIAL(np.linspace(0.0, 1.0, len(found)))), names, None
    norm = Normalize(found.min(), found.max())
    return list(style.SEQUENTIAL(norm(found))), names, ScalarMappable(norm, style.SEQUENTIAL)
