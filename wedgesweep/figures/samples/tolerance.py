"""What tolerances do to a response: percentiles over the samples, over frequency."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from wedgesweep.figures import models, over_axes, style
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "tolerance"
DESCRIPTION = "percentiles of a variable over frequency (or --x), from samples"
NEEDS = ("status",)
ANY_AXES = True

PERCENTILES = (5.0, 25.0, 50.0, 75.0, 95.0)
# Half the width of the band of a single frequency, as a share of it.
HALF_WIDTH = 0.01


def draw(
    target: Target,
    ds: xr.Dataset,
    x: str | None = None,
    facet: str | None = None,
    variable: str | None = None,
    at: Mapping[str, Any] | None = None,
) -> Panels:
    """Draw bands of percentiles of a variable, a panel for each law or each value of ``facet``."""
    variable = variable or over_axes.size_of_motion(ds)
    over_axes.variable_of(ds, variable)
    if "sample" not in ds.dims:
        raise ValueError("needs samples: [sweep.sample] in the config")
    usual = next(name for name in ("scale", "frequency", "beta") if name in ds.dims)
    along = models.coordinate(ds, x or usual)
    if "sample" in ds[along].dims:
        raise ValueError(
            f"{along}: differs from sample to sample; give an axis that all samples share to --x"
        )
    parts, chosen = over_axes.samples(ds, facet, at, along)
    made = panels(target, len(parts), size=(3.3, 3.2))
    for ax, (title, part) in zip(made.axes, parts, strict=True):
        place, values = over_axes.values(part, along), part[variable].transpose("sample", ...).values
        bands = np.nanpercentile(values.astype(float), PERCENTILES, axis=0)
        if len(place) == 1:
            place, bands = place * [1.0 - HALF_WIDTH, 1.0 + HALF_WIDTH], np.repeat(bands, 2, axis=1)
        count = len(PERCENTILES)
        for inner in range(count // 2):
            label = f"{PERCENTILES[inner]:g} to {PERCENTILES[count - 1 - inner]:g} %"
            shade = {"color": style.BLUE, "alpha": 0.2 + 0.2 * inner, "linewidth": 0.0}
            ax.fill_between(place, bands[inner], bands[count - 1 - inner], label=label, **shade)
        ax.plot(place, bands[count // 2], color=style.BLUE, linewidth=1.4, label="median")
        ax.set_title(title, fontsize=10)
    style.label(made.axes, over_axes.label(ds, along), over_axes.short(ds, variable))
    made.legend()
    missing = int(ds[variable].isnull().sum())
    made.title(
        f"Percentiles: {over_axes.meaning(ds, variable)}",
        chosen,
        f"{ds.sizes['sample']} samples",
        f"{missing} cases without a value" if missing else "",
    )
    return made
