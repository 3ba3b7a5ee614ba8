"""Measured and simulated harmonics with the noise of each, test by test."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look

NAME = "harmonics"
DESCRIPTION = "harmonics of displacement and velocity with noise bars, measured and simulated"

STDS = 1.96
LABELS = {"displacement": "$|D_h|$ [mm]", "velocity": "$|V_h|$ [mm/s]"}
DECADES_BELOW_NOISE = 0.5


def magnitude(parts: xr.DataArray) -> np.ndarray:
    """Return magnitudes of complex coefficients stored as real and imaginary part."""
    return np.hypot(parts.sel(part="real").values, parts.sel(part="imaginary").values)


def _draw(ax, found: Diagnosed, test: int, channel: str) -> None:
    one = found.data.sel(channel=channel).isel(test=test)
    order = one["harmonic"].values
    size = magnitude(one["measured_harmonics"]) * style.MM
    noise = one["noise_std"].values * style.MM
    bars = np.array([np.minimum(STDS * noise, 0.999 * size), STDS * noise])
    ax.errorbar(order, size, bars, ecolor="0.4", elinewidth=1.0, capsize=2, **look.MEASURED_DOT)
    ax.fill_between(order, STDS * noise, color="0.88", linewidth=0, zorder=0)
    for model in found.models:
        ax.plot(order, magnitude(one["simulated_harmonics"].sel(model=model)) * style.MM, **look.dot(model))
    ax.set_yscale("log")
    style.power_ticks(ax.yaxis, 5)
    floor = np.nanmin(np.where(noise > 0.0, noise, np.nan)) if (noise > 0.0).any() else np.nan
    if np.isfinite(floor):
        ax.set_ylim(bottom=floor * 10.0**-DECADES_BELOW_NOISE)
    ax.set_xticks(order[:: max(1, order.size // 8)])


def draw(found: Diagnosed, tests: Sequence[int] | None = None) -> Figure:
    """Draw magnitudes over the order, displacement above velocity (default: the six tests as in waveforms).

    To see: marks off the black dot by more than its bar are misfit. Odd harmonics come from what acts alike
    in both directions (friction), even ones from what does not (lean, stops, directional friction). In the
    grey area a harmonic cannot be told from noise.
    """
    figure, panels = look.multiples(
        found, look.choose(found, tests), (2.5, 1.15), found.data.sizes["channel"], between=0.3
    )
    channels = found.data["channel"].values
    for test, axes in panels:
        for ax, channel in zip(axes, channels, strict=True):
            _draw(ax, found, test, channel)
        axes[-1].set_xlabel("harmonic $h$ [1]", fontsize=8.5)
    look.label_sides(panels, *(LABELS[channel] for channel in channels))
    look.legend(figure, found, dots=True)
    style.title(
        figure,
        "Harmonics of $x-y$ and $x'-y'$, measured and simulated",
        "bars: 95 % interval from the periods; grey: below what noise alone reaches",
    )
    return figure
