"""A decay: its peaks, the lines on which dry friction would put them, and the decrement from peak to peak."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from wedgesweep.figures import cases, labels, style, validity
from wedgesweep.figures.panels import Panels, Target, per_law

NAME = "ring-down"
DESCRIPTION = "decay of a release with its logarithmic decrement and the lines of 4F/k, a panel per law"
NEEDS = ("displacement", "time", "scale", "stuck")

# Extremes below this share of the largest have no decrement worth showing.
FAINT = 0.05
LOSS = "friction_decay_per_cycle"


def peaks(time: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of the extremes on both sides, on the parabolas through the samples around them."""
    turns = cases.extremes(x)
    turns = turns[(turns > 0) & (turns < x.size - 1)]
    before, here, after = x[turns - 1], x[turns], x[turns + 1]
    bend = before - 2.0 * here + after
    share = np.where(bend == 0.0, 0.0, 0.5 * (before - after) / np.where(bend == 0.0, 1.0, bend))
    return time[turns] + share * (time[1] - time[0]), here - 0.25 * (before - after) * share


def decrement(values: np.ndarray) -> np.ndarray:
    """Logarithmic decrement of a cycle, from each extreme to the next but one on the same side."""
    size = np.abs(values)
    seen = (size[2:] > FAINT * size.max()) & (size[:-2] > 0.0)
    return np.log(np.where(seen, size[:-2], np.nan) / np.where(seen, size[2:], np.nan))


def _draw_lines(ax: Axes, time: np.ndarray, start: tuple[float, float], loss: float, period: float) -> None:
    """Draw the straight lines between which friction alone lets a motion decay, from its first peak."""
    size = np.maximum(start[1] - loss * (time - start[0]) / period, 0.0)
    for side in (1.0, -1.0):
        ax.plot(time, side * size, color=style.GREY, linestyle="--", linewidth=1.0, zorder=1)


def _draw_decrement(ax: Axes, at: np.ndarray, values: np.ndarray) -> None:
    """Draw the decrement of each cycle on an axis of its own."""
    second, found = ax.twinx(), decrement(values)
    second.plot(at[: found.size], found, "x:", color=style.GREY, markersize=4, linewidth=0.8)
    second.set_ylim(0.0, 1.15 * float(np.nanmax(found, initial=0.1)))
    second.tick_params(labelsize=8, color=style.GREY, labelcolor=style.GREY)
    second.set_ylabel("log decrement per cycle [1] (crosses)", fontsize=8, color=style.GREY)
    second.spines[:].set_visible(False)


def _draw_decay(ax: Axes, case: xr.Dataset, color: str, ds: xr.Dataset) -> None:
    time, x = case["time"].values, case["displacement"].values
    for shade, marked in validity.marked_samples(case).items():
        ax.plot(time, np.where(marked, x, np.nan) * style.MM, color=shade, linewidth=5)
    ax.plot(time, x * style.MM, color=color, linewidth=1.1)
    if not np.isfinite(x).all():
        return
    at, values = peaks(time, x)
    ax.plot(at, values * style.MM, "o", color=color, markersize=3)
    loss = ds.attrs.get(LOSS, np.nan)
    if np.isfinite(loss) and abs(x[0]) > 0.0 and loss > 0.0:
        period = 2.0 * np.pi / ds.attrs["omega_n"]
        _draw_lines(ax, time, (0.0, abs(x[0]) * style.MM), loss * style.MM, period)
    if values.size >= 3:
        _draw_decrement(ax, at, values)


def draw(target: Target, ds: xr.Dataset, scale: float | None = None) -> Panels:
    """Draw a panel per law at a scale, by default the largest."""
    chosen = cases.one_scale(ds, scale)
    made, parts = per_law(target, chosen, columns=2, size=(4.2, 3.4))
    for ax, law, case in parts:
        _draw_decay(ax, case, style.law_style(law)["color"], ds)
        ax.set_title(f"{law}{validity.remark(case)}", fontsize=10)
    style.label(made.axes, "time [s]", labels.of(ds).displacement, columns=2)
    lines = "dashed: dry friction alone, $4F/k$ a cycle" if np.isfinite(ds.attrs.get(LOSS, np.nan)) else ""
    stuck = f"yellow: stuck{validity.note_of_open(ds)}"
    made.title(f"Decay at scale {chosen['scale'].item():.3g}", labels.of(ds).sign, stuck, lines)
    return made
