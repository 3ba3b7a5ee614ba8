"""Peak-to-peak response over frequency at constant input amplitude, as in the experiments."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from wedgesweep.figures import cases, style

NAME = "peak-to-peak"
DESCRIPTION = "peak-to-peak displacement over frequency at fixed amplitudes, laws compared"

PANELS = 3
FEW_FREQUENCIES = 45


def _draw_amplitude(ax, ds: xr.Dataset) -> bool:
    missing = False
    for law in cases.laws(ds):
        look = dict(style.law_style(law))
        if ds.sizes["beta"] > FEW_FREQUENCIES:
            look["marker"] = ""
        height = ds["peak_to_peak"].sel(friction_law=law).values * style.MM
        frequency = ds["frequency"].values
        ax.plot(frequency, height, linewidth=1.3, markersize=3, label=law, **look)
        missing |= style.mark_missing(ax, frequency[np.isnan(height)], look["color"])
    ax.set_title(f"$a$ = {ds['amplitude'].item() * style.MM:.4g} mm", fontsize=10)
    ax.set_ylim(bottom=0.0)
    return missing


def draw(ds: xr.Dataset, amplitudes=None) -> Figure:
    """Draw a panel per amplitude (m; nearest ones, by default three at which something slips)."""
    cases.require_grid(ds, NAME, "peak_to_peak", "stick_fraction", "frequency")
    places = cases.pick_amplitudes(ds, amplitudes, PANELS)
    figure, axes = style.panels(len(places), size=(3.2, 3.2), share=False)
    missing = [_draw_amplitude(ax, ds.isel(amplitude=at)) for ax, at in zip(axes, places, strict=True)]
    style.label(axes, "frequency [Hz]", "peak-to-peak of $x-y$ [mm]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=9, frameon=False)
    style.title(
        figure,
        "Peak-to-peak of $x-y$ (side frame minus bolster) at fixed input amplitude",
        "$\\times$ no result (failed or not run)" if any(missing) else "",
    )
    return figure
