"""Maps over frequency and input amplitude, a panel per law."""

from collections.abc import Callable

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh

from wedgesweep.figures import labels, style
from wedgesweep.figures.panels import Panels, Target, per_law

COLOURS = colormaps["cividis"].with_extremes(bad=style.PURPLE)
# Edges of the cells along frequency and amplitude.
Edges = tuple[np.ndarray, np.ndarray]


def panel_per_law(
    target: Target, ds: xr.Dataset, draw_law: Callable[[Axes, xr.Dataset, Edges], QuadMesh]
) -> tuple[Panels, QuadMesh]:
    """Draw each law by ``draw_law`` in a panel of its own; the panels, and what the colour bar is for."""
    words = labels.of(ds)
    amplitudes = ds["amplitude"].values * words.factor
    logarithmic = bool(amplitudes[0] > 0.0)
    edges = cell_edges(ds["beta"].values, False), cell_edges(amplitudes, logarithmic)
    made, parts = per_law(target, ds, size=(3.3, 3.6))
    for ax, _, law in parts:
        ax.grid(visible=False)
        mesh = draw_law(ax, law, edges)
        ax.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
        style.add_hertz_axis(ax, ds)
    if logarithmic:
        made.axes[0].set_yscale("log")
        style.decimal_ticks(made.axes[0].yaxis)
    style.label(made.axes, style.BETA, words.amplitude)
    return made, mesh


def cell_edges(centres: np.ndarray, logarithmic: bool) -> np.ndarray:
    """Put edges half way between the centres, n + 1 of them; none below 0 where no centre is."""
    x = np.log(centres) if logarithmic else centres.astype(float)
    steps = np.diff(x) if len(x) > 1 else np.array([0.1 if logarithmic else 0.1 * abs(x[0])])
    edges = np.concatenate([[x[0] - steps[0] / 2], x[:-1] + np.diff(x) / 2, [x[-1] + steps[-1] / 2]])
    if logarithmic:
        return np.exp(edges)
    return edges if centres.min() < 0.0 else np.maximum(edges, 0.0)
