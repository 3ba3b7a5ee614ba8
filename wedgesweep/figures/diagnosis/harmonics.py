"""Measured and simulated harmonics with the noise of each, test by test."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import labels, style
from wedgesweep.figures.diagnosis import marks
from wedgesweep.figures.diagnosis.multiples import multiples
from wedgesweep.figures.panels import Panels, Target

NAME = "harmonics"
DESCRIPTION = "harmonics of displacement and velocity with noise bars, measured and simulated"
TESTS = "steady"

LABELS = {"displacement": "$|D_h|$ [mm]", "velocity": "$|V_h|$ [mm/s]"}
DECADES_BELOW_NOISE = 0.5


def magnitude(parts: xr.DataArray) -> np.ndarray:
    """Return magnitudes of complex coefficients stored as real and imaginary part."""
    return np.hypot(parts.sel(part="real").values, parts.sel(part="imaginary").values)


def _draw(ax: Axes, result: DiagnosisResult, test: int, channel: str) -> None:
    one = result.data.sel(channel=channel).isel(test=test)
    order = one["harmonic"].values
    size = magnitude(one["measured_harmonics"]) * style.MM
    noise = one["noise_std"].values * style.MM
    bars = np.array([np.minimum(marks.STDS * noise, 0.999 * size), marks.STDS * noise])
    ax.errorbar(order, size, bars, ecolor="0.4", elinewidth=1.0, capsize=2, **marks.MEASURED_DOT)
    ax.fill_between(order, marks.STDS * noise, color="0.88", linewidth=0, zorder=0)
    for model in result.models:
        ax.plot(order, magnitude(one["simulated_harmonics"].sel(model=model)) * style.MM, **marks.dot(model))
    ax.set_yscale("log")
    style.power_ticks(ax.yaxis, 5)
    floor = np.nanmin(np.where(noise > 0.0, noise, np.nan)) if (noise > 0.0).any() else np.nan
    if np.isfinite(floor):
        ax.set_ylim(bottom=floor * 10.0**-DECADES_BELOW_NOISE)
    ax.set_xticks(order[:: max(1, order.size // 8)])


def draw(target: Target, result: DiagnosisResult, tests: Sequence[int] | None = None) -> Panels:
    """Draw magnitudes over the order, displacement above velocity (default: the six tests that misfit most).

    To see: a mark off the measured dot by more than its bar is misfit. Odd harmonics come from physics
    that acts alike in both directions (friction), even ones from physics that does not (the column angle,
    stops, directional friction). A harmonic in the grey area cannot be distinguished from noise.
    """
    channels = result.data["channel"].values
    made = multiples(target, result, tests, (2.5, 1.15), len(channels), between=0.3)
    for test, axes in made:
        for ax, channel in zip(axes, channels, strict=True):
            _draw(ax, result, test, channel)
        axes[-1].set_xlabel("harmonic $h$ [1]", fontsize=8.5)
    made.label_sides(*(LABELS[channel] for channel in channels))
    marks.legend(made, result, dots=True)
    words = labels.of(result.data)
    symbols = {"displacement": words.motion, "velocity": words.rate}
    made.title(
        f"Harmonics of {' and '.join(f'${symbols[name]}$' for name in channels)}, measured and simulated",
        "bars: 95 % interval; grey: noise alone reaches this height",
    )
    return made
