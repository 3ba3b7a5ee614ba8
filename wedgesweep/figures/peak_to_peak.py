"""Peak-to-peak response over frequency at constant input amplitude, as in the experiments."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from wedgesweep.figures import cases, labels, style, validity
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "peak-to-peak"
DESCRIPTION = "peak-to-peak displacement over frequency at fixed amplitudes, laws compared"
NEEDS = ("peak_to_peak", "stick_fraction", "frequency")

PANELS = 3
FEW_FREQUENCIES = 45


def _draw_amplitude(ax: Axes, ds: xr.Dataset) -> bool:
    missing = False
    for law in cases.laws(ds):
        look = dict(style.law_style(law))
        if ds.sizes["beta"] > FEW_FREQUENCIES:
            look["marker"] = ""
        height = ds["peak_to_peak"].sel(friction_law=law).values * style.MM
        frequency = ds["frequency"].values
        ax.plot(frequency, height, linewidth=1.3, markersize=3, label=law, **look)
        validity.mark(ax, frequency, height, ds.sel(friction_law=law), look["color"])
        missing |= style.mark_missing(ax, frequency[np.isnan(height)], look["color"])
    ax.set_title(labels.of(ds).size(ds["amplitude"].item(), 4), fontsize=10)
    ax.set_ylim(bottom=0.0)
    return missing


def draw(target: Target, ds: xr.Dataset, amplitudes: ArrayLike | None = None) -> Panels:
    """Draw a panel per amplitude (m; nearest ones, by default three at which something slips)."""
    words = labels.of(ds)
    places = cases.pick_amplitudes(ds, amplitudes, PANELS)
    made = panels(target, len(places), size=(3.2, 3.2), share=False)
    axes = made.axes
    missing = [_draw_amplitude(ax, ds.isel(amplitude=at)) for ax, at in zip(axes, places, strict=True)]
    style.label(axes, "frequency [Hz]", f"peak-to-peak of ${words.motion}$ [mm]")
    shown = ds.isel(amplitude=places)
    handles = [*axes[0].get_legend_handles_labels()[0], *validity.handles(shown)]
    made.legend(handles, columns=4)
    made.title(
        f"Peak-to-peak of ${words.motion}$ ({words.whose}) at fixed input amplitude",
        "$\\times$ no result (failed or not run)" * any(missing),
        validity.shares(shown),
    )
    return made
