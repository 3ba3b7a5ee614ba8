"""Where wedges lift off: share of time over frequency and input amplitude."""

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh

from wedgesweep.figures import cases, labels, style
from wedgesweep.figures.panels import Panels, Target, panels
from wedgesweep.figures.stick_map import cell_edges
from wedgesweep.figures.validity import LIFT_OFF, OPENS

NAME = "lift-off-map"
DESCRIPTION = "share of time with an open contact, or with a joint that pulls, over frequency and amplitude"
NEEDS = ("lift_off_fraction", "status", "omega_n")

COLOURS = colormaps["viridis"].with_extremes(bad="0.85", under="white")
# Below this share nothing lifts off: white.
NONE = 1e-12


def _draw_law(ax: Axes, law: xr.Dataset, edges: tuple[np.ndarray, np.ndarray]) -> QuadMesh:
    share = law.transpose("amplitude", "beta", ...)[LIFT_OFF].values
    # NaN: a bolster that never slips does not lift off either, but a failed case has no answer.
    stuck = np.isnan(share) & (law.transpose("amplitude", "beta", ...)["status"].values == 0)
    shown = np.ma.masked_invalid(np.where(stuck, 0.0, share))
    return ax.pcolormesh(*edges, shown, cmap=COLOURS, vmin=NONE, vmax=1.0, rasterized=True)


def draw(target: Target, ds: xr.Dataset) -> Panels:
    """Draw a panel per law."""
    if ds[LIFT_OFF].notnull().any() and not (ds[LIFT_OFF] > 0.0).any():
        message = f"nothing lifts off in these cases: {LIFT_OFF} is never above 0"
        raise ValueError(message)
    words = labels.of(ds)
    amplitudes = ds["amplitude"].values * words.factor
    logarithmic = bool(amplitudes[0] > 0.0)
    edges = cell_edges(ds["beta"].values, False), cell_edges(amplitudes, logarithmic)
    names = cases.laws(ds)
    made = panels(target, len(names), size=(3.3, 3.6))
    for ax, law in zip(made.axes, names, strict=True):
        ax.grid(visible=False)
        mesh = _draw_law(ax, ds.sel(friction_law=law), edges)
        ax.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
        ax.set_title(law, fontsize=10)
        style.add_hertz_axis(ax, ds)
    if logarithmic:
        made.axes[0].set_yscale("log")
        style.decimal_ticks(made.axes[0].yaxis)
    opens = OPENS in ds
    made.colorbar(mesh, "share of a period [1]" if opens else "share of the slipping time [1]")
    style.label(made.axes, style.BETA, words.amplitude)
    what = "a contact open" if opens else "a joint that pulls, where a real wedge would lift off"
    made.title(f"Share of time with {what}", "white: none; grey: no result")
    return made
