"""Any number of the cases as a colour over two axes of the sweep."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from wedgesweep.figures import over_axes, style
from wedgesweep.figures.maps import COLOURS, cell_edges
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "map"
DESCRIPTION = "a variable over any two axes of the sweep (--x, --y), a panel for each value of --facet"
NEEDS = ("status",)
ANY_AXES = True

# An axis whose values grow by a constant factor, to this share, is drawn on a logarithmic scale.
EVEN = 0.01


def _is_logarithmic(values: np.ndarray) -> bool:
    if len(values) < 3 or (values <= 0.0).any():
        return False
    ratios = values[1:] / values[:-1]
    return bool(np.ptp(ratios) < EVEN * ratios[0])


def draw(
    target: Target,
    ds: xr.Dataset,
    x: str | None = None,
    y: str | None = None,
    facet: str | None = None,
    variable: str = "stick_fraction",
    at: Mapping[str, Any] | None = None,
) -> Panels:
    """Draw a variable over the axes ``x`` and ``y``; by default the two longest."""
    ds, layout = over_axes.laid_out(ds, x, y, facet, at, numbers=True)
    if layout.other is None:
        raise ValueError("needs two axes with several values")
    shown = over_axes.variable_of(ds, variable)
    parts = over_axes.panels_of(ds, layout.facet)
    low, high = float(shown.min()), float(shown.max())
    limits = (0.0, 1.0) if variable.endswith("_fraction") else (low, high if high > low else low + 1.0)
    made = panels(target, len(parts), size=(3.3, 3.2))
    dims = [ds[name].dims[0] for name in (layout.other, layout.x)]
    for ax, (title, part) in zip(made.axes, parts, strict=True):
        ax.grid(visible=False)
        scales = [_is_logarithmic(over_axes.values(part, name)) for name in (layout.x, layout.other)]
        edges = [
            cell_edges(over_axes.values(part, name), log)
            for name, log in zip((layout.x, layout.other), scales, strict=True)
        ]
        numbers = np.ma.masked_invalid(part[variable].transpose(*dims).values)
        mesh = ax.pcolormesh(*edges, numbers, cmap=COLOURS, vmin=limits[0], vmax=limits[1], rasterized=True)
        ax.set(xscale="log" if scales[0] else "linear", yscale="log" if scales[1] else "linear")
        ax.set_title(title, fontsize=10)
    style.label(made.axes, over_axes.label(ds, layout.x), over_axes.label(ds, layout.other))
    made.colorbar(mesh, over_axes.short(ds, variable))
    missing = "purple: no result (failed, or not run)" * bool(shown.isnull().any())
    made.title(over_axes.meaning(ds, variable), over_axes.picked(ds, layout), missing)
    return made
