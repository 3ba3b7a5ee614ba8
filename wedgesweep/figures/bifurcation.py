"""Poincare samples: the displacement once per forcing period, over frequency."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from wedgesweep.figures import cases, labels, style
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "bifurcation"
DESCRIPTION = "Poincare samples of the displacement over frequency at one amplitude"
NEEDS = ("displacement", "omega_n")

FEW_BETAS = 60


def poincare_samples(ds: xr.Dataset) -> np.ndarray:
    """Take the displacement (m) at forcing phase 0, the kept periods along the last axis."""
    return ds["displacement"].transpose(..., "phase").values[..., :: cases.samples_per_period(ds)]


def _draw_law(ax: Axes, law: xr.Dataset) -> bool:
    samples = poincare_samples(law) * style.MM
    periods = samples.shape[-1]
    largest = 7.5 if law.sizes["beta"] <= FEW_BETAS else 3.5
    for period, values in enumerate(samples.T):
        # Rings that shrink from period to period keep coinciding samples visible.
        size = largest * (1.0 - 0.65 * period / max(periods - 1, 1))
        color = style.SEQUENTIAL(0.95 - 0.95 * period / max(periods - 1, 1))
        name = f"kept period {period + 1}"
        ax.plot(
            law["beta"],
            values,
            "o",
            markersize=size,
            markerfacecolor="none",
            color=color,
            label=name,
        )
    return style.mark_missing(ax, law["beta"].values[np.isnan(samples).all(axis=1)], style.GREY)


def draw(target: Target, ds: xr.Dataset, amplitude: float | None = None) -> Panels:
    """Draw a panel per law at the amplitude (m) nearest to the given one (default: the middle)."""
    middle = ds["amplitude"].values[ds.sizes["amplitude"] // 2]
    place = cases.nearest(ds["amplitude"], middle if amplitude is None else amplitude)[0]
    ds = ds.isel(amplitude=place)
    names, words = cases.laws(ds), labels.of(ds)
    made = panels(target, len(names), size=(3.3, 3.5))
    axes = made.axes
    missing = False
    for ax, law in zip(axes, names, strict=True):
        missing |= _draw_law(ax, ds.sel(friction_law=law))
        style.add_hertz_axis(ax, ds)
        ax.set_title(law, fontsize=10)
    style.label(axes, style.BETA, words.displacement)
    made.legend(*axes[0].get_legend_handles_labels(), columns=6)
    made.title(
        f"Displacement at forcing phase 0 (${words.input}$ = 0, rising) of each kept period, "
        f"{words.size(ds['amplitude'].item(), 4)}",
        words.sign + ("; $\\times$ no result" if missing else ""),
    )
    return made
