"""Where the suspension sticks: stick fraction over frequency and input amplitude."""

from math import nan

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from wedgesweep.figures import cases, labels, style, validity
from wedgesweep.figures.maps import COLOURS, Edges, panel_per_law
from wedgesweep.figures.panels import Panels, Target

NAME = "stick-map"
DESCRIPTION = "stick fraction over frequency and amplitude, with lift-off and breakaway"
NEEDS = ("stick_fraction", "omega_n", "breakaway_acceleration")

FEW_FAILURES = 50
FEWEST_AMPLITUDES = 4
MOST_POINTS = 1500  # sampled points that are marked


def _hatch(
    ax: Axes, beta_edges: np.ndarray, amplitude_edges: np.ndarray, marked: np.ndarray, pattern: str
) -> None:
    """Hatch the marked cells as whole regions, along their edges."""
    if not marked.any():
        return
    # Each cell as four corner points of one value, so that a contour runs along the cell edges.
    x, y = np.repeat(beta_edges, 2)[1:-1], np.repeat(amplitude_edges, 2)[1:-1]
    corners = np.repeat(np.repeat(marked, 2, axis=0), 2, axis=1).astype(float)
    region = ax.contourf(x, y, corners, levels=[0.5, 1.5], colors="none", hatches=[pattern])
    region.set(edgecolor="white", linewidth=0.0, hatch_linewidth=0.5)
    ax.contour(x, y, corners, levels=[0.5], colors="white", linewidths=0.9)


def _draw_law(ax: Axes, law: xr.Dataset, edges: Edges) -> QuadMesh:
    law = law.transpose("amplitude", "beta", ...)
    fraction = np.ma.masked_invalid(law["stick_fraction"].values)
    mesh = ax.pcolormesh(*edges, fraction, cmap=COLOURS, vmin=0.0, vmax=1.0, rasterized=True)
    _hatch(ax, *edges, validity.lifted(law).values, "///")
    _hatch(ax, *edges, validity.unsettled(law).values, "....")
    if law["status"].size <= MOST_POINTS:
        beta, amplitude = np.meshgrid(law["beta"], law["amplitude"] * labels.of(law).factor)
        ax.plot(beta.ravel(), amplitude.ravel(), ".", color="white", markersize=1.5, alpha=0.6)
    rows, columns = np.nonzero(np.isnan(law["stick_fraction"].values))
    if 0 < len(rows) <= FEW_FAILURES:
        # On a fine grid the colour of a single cell would be overlooked.
        amplitudes, beta = law["amplitude"].values[rows] * labels.of(law).factor, law["beta"].values[columns]
        ax.plot(beta, amplitudes, "x", color=style.PURPLE, markersize=6, markeredgewidth=1.8)
    return mesh


def _draw_breakaway(ax: Axes, ds: xr.Dataset) -> None:
    """Draw where the bolster may slip from rest, and dashed where it has to."""
    lowest, highest = ax.get_xlim()
    beta = np.linspace(lowest, highest, 1001)[1:]
    for acceleration, dashes in ((ds.attrs["breakaway_acceleration"], "-"), (_latest_breakaway(ds), "--")):
        amplitude = acceleration / (beta * ds.attrs["omega_n"]) ** 2 * style.MM
        ax.plot(beta, amplitude, color="white", linewidth=3.2)
        ax.plot(beta, amplitude, color=style.VERMILLION, linewidth=1.8, linestyle=dashes)


def _latest_breakaway(ds: xr.Dataset) -> float:
    """Base acceleration (m/s2) at which slip from rest is enforced; NaN if none, or not one, is known."""
    values = np.unique(ds["breakaway_max"]) if "breakaway_max" in ds else np.empty(0)
    values = values[np.isfinite(values)]
    return float(values[0]) if values.size == 1 else nan


def _legend(made: Panels, ds: xr.Dataset) -> None:
    """Explain the marks that are there, in one column if there is a single panel."""
    line = {"color": style.VERMILLION, "linewidth": 2}
    hatched = {"facecolor": COLOURS(0.3), "edgecolor": "white"}
    handles: list[Artist] = []
    if np.isfinite(ds.attrs["breakaway_acceleration"]):
        handles.append(Line2D([], [], label="breakaway from rest, $a = A/ω^2$", **line))
    if np.isfinite(_latest_breakaway(ds)):
        label = "the same, if locked-in forces hold it"
        handles.append(Line2D([], [], label=label, linestyle="--", **line))
    for marked, pattern, text in (
        (validity.lifted(ds), "////", "lift-off: outside of validity"),
        (validity.unsettled(ds), "....", "not settled"),
    ):
        if marked.any():
            share = f" ({100.0 * float(marked.mean()):.2g} % of cases)"
            handles.append(Patch(label=text + share, hatch=pattern, **hatched))
    if ds["stick_fraction"].isnull().any():
        handles.append(Patch(facecolor=style.PURPLE, label="no result (failed or not run)"))
    made.legend(handles, columns=1 if len(made.axes) == 1 else 3)


def draw(target: Target, ds: xr.Dataset) -> Panels:
    """Draw a panel per law, lift-off hatched, and the line above which coulomb slip begins."""
    if ds.sizes["amplitude"] < FEWEST_AMPLITUDES:
        raise ValueError(
            f"needs {FEWEST_AMPLITUDES} amplitudes or more for a map; there are {ds.sizes['amplitude']}"
        )
    made, mesh = panel_per_law(target, ds, _draw_law)
    for ax in made.axes:
        _draw_breakaway(ax, ds)
    made.colorbar(mesh, "stick fraction of a period [1]")
    _legend(made, ds)
    made.title(f"Share of time: {labels.sticking(cases.laws(ds))}")
    return made
