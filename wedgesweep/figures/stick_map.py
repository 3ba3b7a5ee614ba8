"""Where the suspension sticks: stick fraction over frequency and input amplitude."""

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from wedgesweep.figures import cases, style

NAME = "stick-map"
DESCRIPTION = "stick fraction over frequency and amplitude, with lift-off and breakaway"

FEW_FAILURES = 50
COLOURS = colormaps["cividis"].with_extremes(bad=style.PURPLE)


def is_logarithmic(values: np.ndarray) -> bool:
    """Tell whether the steps of a grid are more even in ratio than in difference."""
    if len(values) < 3 or values[0] <= 0.0:
        return False
    ratios, differences = np.diff(np.log(values)), np.diff(values)
    return ratios.std() / ratios.mean() < differences.std() / differences.mean()


def cell_edges(centres: np.ndarray, logarithmic: bool) -> np.ndarray:
    """Put edges half way between the centres, n + 1 of them."""
    x = np.log(centres) if logarithmic else centres.astype(float)
    steps = np.diff(x) if len(x) > 1 else np.array([0.1 if logarithmic else 0.1 * abs(x[0])])
    edges = np.concatenate([[x[0] - steps[0] / 2], x[:-1] + np.diff(x) / 2, [x[-1] + steps[-1] / 2]])
    return np.exp(edges) if logarithmic else np.maximum(edges, 0.0)


def _hatch(ax, beta_edges, amplitude_edges, marked: np.ndarray) -> None:
    """Hatch the marked cells as whole regions, along their edges."""
    if not marked.any():
        return
    # Each cell as four corner points of one value, so that a contour runs along the cell edges.
    x, y = np.repeat(beta_edges, 2)[1:-1], np.repeat(amplitude_edges, 2)[1:-1]
    corners = np.repeat(np.repeat(marked, 2, axis=0), 2, axis=1).astype(float)
    region = ax.contourf(x, y, corners, levels=[0.5, 1.5], colors="none", hatches=["///"])
    region.set(edgecolor="white", linewidth=0.0, hatch_linewidth=0.5)
    ax.contour(x, y, corners, levels=[0.5], colors="white", linewidths=0.9)


def _draw_law(ax, law: xr.Dataset, edges: tuple[np.ndarray, np.ndarray]):
    law = law.transpose("amplitude", "beta", ...)
    fraction = np.ma.masked_invalid(law["stick_fraction"].values)
    mesh = ax.pcolormesh(*edges, fraction, cmap=COLOURS, vmin=0.0, vmax=1.0, rasterized=True)
    _hatch(ax, *edges, law["lift_off_fraction"].values > 0.0)
    rows, columns = np.nonzero(np.isnan(law["stick_fraction"].values))
    if 0 < len(rows) <= FEW_FAILURES:
        # On a fine grid the colour of a single cell would be overlooked.
        amplitudes, beta = law["amplitude"].values[rows] * style.MM, law["beta"].values[columns]
        ax.plot(beta, amplitudes, "x", color=style.PURPLE, markersize=6, markeredgewidth=1.8)
    return mesh


def _draw_breakaway(ax, ds: xr.Dataset) -> None:
    lowest, highest = ax.get_xlim()
    beta = np.linspace(lowest, highest, 1001)[1:]
    amplitude = ds.attrs["breakaway_acceleration"] / (beta * ds.attrs["omega_n"]) ** 2 * style.MM
    ax.plot(beta, amplitude, color="white", linewidth=3.2)
    ax.plot(beta, amplitude, color=style.VERMILLION, linewidth=1.8)


def _legend(figure: Figure, ds: xr.Dataset) -> None:
    """Explain what is there; in one column where the figure is a single panel."""
    line = {"color": style.VERMILLION, "linewidth": 2}
    hatched = {"facecolor": COLOURS(0.3), "edgecolor": "white", "hatch": "////"}
    handles = []
    if np.isfinite(ds.attrs["breakaway_acceleration"]):
        handles.append(Line2D([], [], label="breakaway from rest, $a = A/ω^2$", **line))
    if (ds["lift_off_fraction"] > 0.0).any():
        handles.append(Patch(label="lift-off at some time", **hatched))
    if ds["stick_fraction"].isnull().any():
        handles.append(Patch(facecolor=style.PURPLE, label="no result (failed or not run)"))
    place = {"loc": "outside lower center", "ncols": 1 if len(cases.laws(ds)) == 1 else 3}
    figure.legend(handles=handles, fontsize=8, frameon=False, **place)


def draw(ds: xr.Dataset) -> Figure:
    """Draw a panel per law, lift-off hatched, and the line above which coulomb slip begins."""
    needed = ("stick_fraction", "lift_off_fraction", "omega_n", "breakaway_acceleration")
    cases.require_grid(ds, NAME, *needed)
    amplitudes = ds["amplitude"].values * style.MM
    logarithmic = is_logarithmic(amplitudes)
    edges = cell_edges(ds["beta"].values, False), cell_edges(amplitudes, logarithmic)
    names = cases.laws(ds)
    figure, axes = style.panels(len(names), size=(3.3, 3.6))
    for ax, law in zip(axes, names, strict=True):
        ax.grid(visible=False)
        mesh = _draw_law(ax, ds.sel(friction_law=law), edges)
        ax.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
        ax.set_title(law, fontsize=10)
    if logarithmic:
        axes[0].set_yscale("log")
        style.decimal_ticks(axes[0].yaxis)
    for ax in axes:
        _draw_breakaway(ax, ds)
        style.add_hertz_axis(ax, ds)
    bar = figure.colorbar(mesh, ax=axes, aspect=30, pad=0.02)
    bar.set_label("stick fraction of a period", fontsize=9)
    bar.ax.tick_params(labelsize=8)
    style.label(axes, style.BETA, style.AMPLITUDE)
    _legend(figure, ds)
    style.title(figure, "Share of time stuck (coulomb) or with the column slip below $v_t$ (other laws)")
    return figure
