"""How far off the models are, in units of the noise: per test, and per harmonic."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look

NAME = "misfit"
DESCRIPTION = "misfit over noise of every test and harmonic, before and after"

STDS = 1.96
LARGEST = 1e3  # in units of noise; beyond it the colour stays
# Pale where nothing is wrong: on paper, and with light and dark exchanged on a dark page.
COLORS = colormaps["BuPu"]


def deviations(found: Diagnosed, model: str) -> np.ndarray:
    """Distance of model and measurement over the noise, (test, channel * harmonic); 1 in noise alone."""
    data = found.data
    gap = data["measured_harmonics"] - data["simulated_harmonics"].sel(model=model)
    squared = (gap**2).sum("part", skipna=False) / (2.0 * data["noise_std"] ** 2)
    table = np.sqrt(squared.transpose("test", "channel", "harmonic").values)
    return table.reshape(len(table), -1)


def _draw_tests(ax, found: Diagnosed, order: np.ndarray) -> None:
    rows = np.arange(order.size)
    dof = found.data["dof"].values[order]
    half = STDS * np.sqrt(2.0 / np.maximum(dof, 1.0))
    ax.barh(rows, 2.0 * half, left=1.0 - half, height=0.9, color="0.85", label="noise alone (95 %)")
    for model, name in look.names(found).items():
        ratio = found.data["q"].sel(model=model).values[order] / dof
        ax.plot(ratio, rows, label=name, **look.dot(model))
    ratios = (found.data["q"].sel(model=list(found.models)) / found.data["dof"]).values
    ax.set_xscale("log")
    ax.set_xlim(min(0.5, 0.7 * np.nanmin(ratios)), max(3.0, 1.6 * np.nanmax(ratios)))
    style.log_ticks(ax.xaxis)
    ax.set_yticks(rows, [look.label(found.data, test) for test in order])
    ax.set_ylim(order.size - 0.4, -0.6)
    ax.set_xlabel("misfit per degree of freedom Q/dof [1]", fontsize=9)


def _draw_map(ax, found: Diagnosed, model: str, order: np.ndarray, norm: LogNorm) -> None:
    table = deviations(found, model)[order]
    ax.grid(visible=False)
    ax.set_facecolor("0.9")
    ax.imshow(np.clip(table, norm.vmin, None), aspect="auto", cmap=COLORS, norm=norm)
    harmonics = found.data.sizes["harmonic"]
    ticks, words = [], []
    for place, channel in enumerate(found.data["channel"].values):
        if place:
            ax.axvline(place * harmonics - 0.5, color="0.3", linewidth=1.5)
        ticks += [place * harmonics + h for h in range(0, harmonics, 4)]
        words += [str(h + 1) for h in range(0, harmonics, 4)]
        where = {"transform": ax.get_xaxis_transform(), "ha": "center", "va": "bottom", "fontsize": 8}
        ax.text((place + 0.5) * harmonics - 0.5, 1.01, channel, **where)
    ax.set_xticks(ticks, words)
    ax.set_xlabel("harmonic [1]", fontsize=9)
    ax.set_title(look.names(found)[model], fontsize=9.5, pad=16)


def draw(found: Diagnosed) -> Figure:
    """Draw Q/dof of every test, and beside it how far each harmonic is off, in units of its noise.

    To see: a model that misses nothing keeps every test in the grey bar and its map pale. Which rows (tests)
    and columns (harmonics) are strong shows where the physics that is missing acts.
    """
    order = look.by_frequency(found.data)
    count = 1 + len(found.models)
    height = max(look.per_test_height(order.size), 2.4)
    figure, axes = style.panels(count, columns=count, size=(3.2, height), share=False, margin=(1.2, 0.9))
    _draw_tests(axes[0], found, order)
    top = np.nanmax([10.0, *(np.nanmax(deviations(found, model)) for model in found.models)])
    norm = LogNorm(1.0, min(top, LARGEST))
    for ax, model in zip(axes[1:], found.models, strict=True):
        _draw_map(ax, found, model, order, norm)
        ax.set_yticks(range(order.size), [""] * order.size)
    bar = figure.colorbar(ScalarMappable(norm, COLORS), ax=axes[1:], aspect=25, pad=0.02)
    style.decimal_ticks(bar.ax.yaxis)
    bar.ax.tick_params(labelsize=8)
    bar.set_label("off by [noise std]", fontsize=8.5)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=9, frameon=False)
    style.title(figure, "Misfit in units of the noise, by test and by harmonic", "1 is noise alone")
    return figure
