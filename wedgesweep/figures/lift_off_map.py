"""Where wedges lift off: share of time over frequency and input amplitude."""

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh

from wedgesweep.figures.maps import Edges, panel_per_law
from wedgesweep.figures.panels import Panels, Target
from wedgesweep.outcome import LIFT_OFF, OPENS

NAME = "lift-off-map"
DESCRIPTION = "share of time with an open contact, or with a joint that pulls, over frequency and amplitude"
NEEDS = ("lift_off_fraction", "status", "omega_n")

COLOURS = colormaps["viridis"].with_extremes(bad="0.85", under="white")
# Below this share nothing lifts off: white.
NONE = 1e-12


def _draw_law(ax: Axes, law: xr.Dataset, edges: Edges) -> QuadMesh:
    share = law.transpose("amplitude", "beta", ...)[LIFT_OFF].values
    # NaN: a bolster that never slips does not lift off either, but a failed case has no answer.
    stuck = np.isnan(share) & (law.transpose("amplitude", "beta", ...)["status"].values == 0)
    shown = np.ma.masked_invalid(np.where(stuck, 0.0, share))
    return ax.pcolormesh(*edges, shown, cmap=COLOURS, vmin=NONE, vmax=1.0, rasterized=True)


def draw(target: Target, ds: xr.Dataset) -> Panels:
    """Draw a panel per law."""
    if ds[LIFT_OFF].notnull().any() and not (ds[LIFT_OFF] > 0.0).any():
        raise ValueError(f"nothing lifts off in these cases: {LIFT_OFF} is never above 0")
    made, mesh = panel_per_law(target, ds, _draw_law)
    opens = OPENS in ds
    made.colorbar(mesh, "share of a period [1]" if opens else "share of the slipping time [1]")
    what = "a contact open" if opens else "a joint that pulls, where a real wedge would lift off"
    made.title(f"Share of time with {what}", "white: none; grey: no result")
    return made
