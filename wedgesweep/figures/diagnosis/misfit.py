"""How far off the models are, in units of the noise: per test, and per harmonic."""

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import marks, rows, selection
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "misfit"
DESCRIPTION = "misfit over noise of every test and harmonic, before and after"
TESTS = "steady"

LARGEST = 1e3  # in units of noise; beyond it the colour stays
# Pale where nothing is wrong: on paper, and with light and dark exchanged on a dark page.
COLORS = colormaps["BuPu"]


def deviations(result: DiagnosisResult, model: str) -> np.ndarray:
    """Distance of model and measurement over the noise, (test, channel * harmonic); 1 in noise alone."""
    data = result.data
    gap = data["measured_harmonics"] - data["simulated_harmonics"].sel(model=model)
    squared = (gap**2).sum("part", skipna=False) / (2.0 * data["noise_std"] ** 2)
    table = np.sqrt(squared.transpose("test", "channel", "harmonic").values)
    return table.reshape(len(table), -1)


def _draw_tests(ax: Axes, result: DiagnosisResult, order: np.ndarray) -> None:
    places = np.arange(order.size)
    dof = result.data["dof"].values[order]
    half = marks.STDS * np.sqrt(2.0 / np.maximum(dof, 1.0))
    ax.barh(places, 2.0 * half, left=1.0 - half, height=0.9, color="0.85", label="noise alone (95 %)")
    for model, name in marks.names(result).items():
        ratio = result.data["q"].sel(model=model).values[order] / dof
        ax.plot(ratio, places, label=name, **marks.dot(model))
    ratios = (result.data["q"].sel(model=list(result.models)) / result.data["dof"]).values
    ax.set_xscale("log")
    ratios = ratios[ratios > 0.0]
    ax.set_xlim(min(0.5, 0.7 * ratios.min(initial=1.0)), max(3.0, 1.6 * ratios.max(initial=1.0)))
    style.log_ticks(ax.xaxis)
    ax.set_xlabel("misfit per degree of freedom Q/dof [1]", fontsize=9)


def _draw_map(ax: Axes, result: DiagnosisResult, model: str, order: np.ndarray, norm: LogNorm) -> None:
    table = deviations(result, model)[order]
    ax.grid(visible=False)
    ax.set_facecolor("0.9")
    ax.imshow(np.clip(table, norm.vmin, None), aspect="auto", cmap=COLORS, norm=norm)
    harmonics = result.data.sizes["harmonic"]
    ticks, labels = [], []
    for place, channel in enumerate(result.data["channel"].values):
        if place:
            ax.axvline(place * harmonics - 0.5, color="0.3", linewidth=1.5)
        ticks += [place * harmonics + h for h in range(0, harmonics, 4)]
        labels += [str(h + 1) for h in range(0, harmonics, 4)]
        where = {"transform": ax.get_xaxis_transform(), "ha": "center", "va": "bottom", "fontsize": 8}
        ax.text((place + 0.5) * harmonics - 0.5, 1.01, channel, **where)
    ax.set_xticks(ticks, labels)
    ax.set_xlabel("harmonic [1]", fontsize=9)
    ax.set_title(marks.names(result)[model], fontsize=9.5, pad=16)


def draw(target: Target, result: DiagnosisResult) -> Panels:
    """Draw Q/dof of every test, and beside it how far each harmonic is off, in units of its noise.

    To see: a model that misses nothing keeps every test within the grey bar and its map pale. The dark rows
    (tests) and columns (harmonics) show where the missing physics acts.
    """
    order = selection.by_frequency(result.data)
    count = 1 + len(result.models)
    size = 3.2, max(rows.height(order.size), 2.4)
    made = panels(target, count, columns=count, size=size, share=False, margin=(1.2, 0.9))
    tests, *maps = made.axes
    _draw_tests(tests, result, order)
    rows.set_rows(tests, result, order, named=True)
    top = np.nanmax([10.0, *(np.nanmax(deviations(result, model)) for model in result.models)])
    norm = LogNorm(1.0, min(top, LARGEST))
    for ax, model in zip(maps, result.models, strict=True):
        _draw_map(ax, result, model, order, norm)
        rows.set_rows(ax, result, order, named=False)
    bar = made.colorbar(ScalarMappable(norm, COLORS), "deviation [noise std]", maps)
    style.decimal_ticks(bar.ax.yaxis)
    made.legend()
    made.title("Misfit in units of the noise, by test and by harmonic", "noise alone leaves 1")
    return made
