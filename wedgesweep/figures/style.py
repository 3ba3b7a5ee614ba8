"""The look of every figure: colours, and axes with their units."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import ListedColormap
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from wedgesweep import formatting
from wedgesweep.friction.names import LAW_NAMES

MM = 1e3  # mm per m

# Okabe and Ito's palette, distinguishable with any colour vision.
BLUE, VERMILLION, GREEN = "#0072B2", "#D55E00", "#009E73"
PURPLE, YELLOW = "#CC79A7", "#F0E442"
LAW_STYLES = (
    {"color": BLUE, "linestyle": "-", "marker": "o"},
    {"color": VERMILLION, "linestyle": "--", "marker": "s"},
    {"color": GREEN, "linestyle": "-.", "marker": "^"},
    {"color": PURPLE, "linestyle": ":", "marker": "D"},
)
STUCK, OPEN = YELLOW, "#56B4E9"  # as highlighters behind the curve
GREY = "0.45"
# The light end of viridis is left out: yellow lines vanish on white.
SEQUENTIAL = ListedColormap(colormaps["viridis"](np.linspace(0.0, 0.9, 256)))

SIGN = "$x-y$: side frame minus bolster, from the frictionless rest position"
BETA = "frequency ratio $β = ω/ω_n$ [1]"


def law_style(law: str) -> dict[str, str]:
    """Return colour, line and marker of a law: the same in every figure."""
    place = LAW_NAMES.index(law) if law in LAW_NAMES else len(LAW_NAMES)
    return LAW_STYLES[place % len(LAW_STYLES)]


def frequency(beta: float, omega_n: float) -> str:
    """Write a frequency ratio and what it is in Hz."""
    return f"$β$ = {beta:.4g} ({beta * omega_n / (2.0 * np.pi):.4g} Hz)"


def dress(ax: Axes) -> None:
    """Give axes the frame and the grid that all of them have."""
    ax.tick_params(labelsize=8, color=GREY)
    ax.grid(visible=True, color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
    ax.spines[["left", "bottom"]].set_color(GREY)


def label(axes: Sequence[Axes], x: str, y: str, columns: int = 3) -> None:
    """Label every x axis of the lowest panels of each column, and the y axes on the left."""
    columns = min(columns, len(axes))
    for place, ax in enumerate(axes):
        lowest = place + columns >= len(axes)
        # Labels that are not drawn tell the unit of their axis.
        ax.set_xlabel(x, fontsize=9, visible=lowest)
        ax.set_ylabel(y, fontsize=9, visible=place % columns == 0)
        if lowest:
            ax.tick_params(labelbottom=True)


def add_hertz_axis(ax: Axes, ds: xr.Dataset) -> None:
    """Add a second axis above: frequency in Hz for the frequency ratios below."""
    hertz = ds.attrs["omega_n"] / (2.0 * np.pi)
    top = ax.secondary_xaxis("top", functions=(lambda beta: beta * hertz, lambda f: f / hertz))
    top.set_xlabel("frequency [Hz]", fontsize=8, color=GREY)
    top.tick_params(labelsize=8, color=GREY, labelcolor=GREY)
    top.spines["top"].set_color(GREY)


def decimal_ticks(axis: Axis) -> None:
    """Put 1, 2, 5, 10 ... in plain decimals on a logarithmic axis."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())


def log_ticks(axis: Axis) -> None:
    """Choose the ticks of a logarithmic axis that has its limits: powers of ten, or decimals between them."""
    low, high = axis.get_view_interval()
    (power_ticks if high > 100.0 * low else decimal_ticks)(axis)


def _power_of_ten(value: float, _: int | None) -> str:
    """Label of a tick; matplotlib also asks for that of 0, where an axis has no positive number."""
    return formatting.power(round(np.log10(value))) if value > 0.0 else ""


def power_ticks(axis: Axis, count: int = 6) -> None:
    """Put powers of ten, at most ``count`` of them, on a logarithmic axis."""
    axis.set_major_locator(LogLocator(numticks=count))
    axis.set_major_formatter(FuncFormatter(_power_of_ten))
    axis.set_minor_locator(NullLocator())


def mark_missing(ax: Axes, positions: np.ndarray, color: str) -> bool:
    """Mark cases without a result by crosses on the bottom; return whether there were any."""
    if len(positions) == 0:
        return False
    height = [0.015] * len(positions)
    place = {"transform": ax.get_xaxis_transform(), "clip_on": False, "zorder": 5}
    ax.plot(positions, height, "x", color=color, markersize=6, markeredgewidth=1.8, **place)
    return True
