"""What the figures of a diagnosis share: who is drawn how, which tests, and panels in pairs."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from wedgesweep import digits
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style

SHOWN = 6  # tests in a figure by default, those with the largest misfit
COLUMNS = 3
# Inches around the panels of small multiples: title and legend, and between panels.
TOP, BOTTOM, LEFT, BESIDE, TITLE, BELOW = 0.62, 0.36, 0.72, 0.6, 0.42, 0.46
MEASURED = {"color": "black", "linewidth": 2.8}
COLORS = {"base": style.VERMILLION, "extended": style.BLUE}
LINES = {"base": "--", "extended": "-"}
MARKERS = {"base": "x", "extended": "+"}
MEASURED_DOT = {"marker": "o", "linestyle": "none", "color": "black", "markersize": 4.5}


def names(found: Diagnosed) -> dict[str, str]:
    """Legend of each model that is shown."""
    extended = "best attempt" if not found.document["causes"] else "extended"
    words = {"base": "base model", "extended": f"{extended}: {' + '.join(found.added)}"}
    return {model: words[model] for model in found.models}


def dot(model: str) -> dict[str, object]:
    """Draw a number of a model as an open mark, so that the measured dot behind it stays visible."""
    size = {"markersize": 8.5 if model == "extended" else 6, "markeredgewidth": 1.6}
    return {"marker": MARKERS[model], "linestyle": "none", "color": COLORS[model], **size}


def line(model: str) -> dict[str, object]:
    """Draw a signal of a model."""
    return {"linestyle": LINES[model], "color": COLORS[model], "linewidth": 1.2}


def legend(figure: Figure, found: Diagnosed, dots: bool) -> None:
    """Say below the panels who is who."""
    measured: dict[str, object] = MEASURED_DOT if dots else MEASURED
    looks = {model: dot(model) if dots else line(model) for model in found.models}
    handles = [Line2D([], [], **measured), *(Line2D([], [], **look) for look in looks.values())]
    labels = ["measured", *names(found).values()]
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=9, frameon=False)


def by_misfit(data: xr.Dataset) -> np.ndarray:
    """Indices of the tests, the base model's largest misfit per degree of freedom first."""
    ratio = (data["q"].sel(model="base") / data["dof"]).values
    return np.argsort(-np.nan_to_num(ratio, nan=np.inf), kind="stable")


def choose(found: Diagnosed, tests: Sequence[int] | None) -> np.ndarray:
    """Indices of the tests asked for, or of those with the largest misfit."""
    return by_misfit(found.data)[:SHOWN] if tests is None else np.asarray(tests, int)


def by_frequency(data: xr.Dataset) -> np.ndarray:
    """Indices of the tests by amplitude and frequency, as a bench would run them."""
    amplitude = data["amplitude_fitted"].sel(model="extended").values
    return np.lexsort((data["frequency"].values, np.round(np.log(amplitude), 1)))


def label(data: xr.Dataset, test: int) -> str:
    """Name, frequency and input amplitude of a test; an amplitude that was only fitted is marked."""
    stated = data["amplitude"].values[test]
    fitted = data["amplitude_fitted"].sel(model="extended").values[test]
    size = f"{stated * style.MM:.3g} mm" if np.isfinite(stated) else f"~{fitted * style.MM:.2g} mm"
    return f"{data['test'].values[test]}: {data['frequency'].values[test]:.4g} Hz, {size}"


def misfit_label(found: Diagnosed, test: int) -> str:
    """Misfit per degree of freedom of each model in a test."""
    ratios = [found.data["q"].sel(model=model) / found.data["dof"] for model in found.models]
    return "Q/dof " + " → ".join(digits.number(ratio.values[test]) for ratio in ratios)


def multiples(
    found: Diagnosed, tests: Sequence[int], size: tuple[float, float], parts: int = 1, between: float = 0.0
) -> tuple[Figure, list[tuple[int, list[Axes]]]]:
    """Make ``parts`` panels of a size (inches) per test, one above the other; return tests with panels.

    Everything has its fixed place: with dozens of panels a layout by measuring takes longer than the drawing.
    """
    columns = min(COLUMNS, len(tests))
    rows = -(-len(tests) // columns)
    across, down = size[0] + BESIDE, TITLE + parts * size[1] + (parts - 1) * between + BELOW
    width, height = max(LEFT + columns * across, 6.0), TOP + rows * down + BOTTOM
    figure = Figure(figsize=(width, height))

    def panel(place: int, part: int) -> Axes:
        x = LEFT + place % columns * across
        y = height - TOP - place // columns * down - TITLE - part * (size[1] + between) - size[1]
        ax = figure.add_axes((x / width, y / height, size[0] / width, size[1] / height))
        style.dress(ax)
        ax.tick_params(labelsize=7.5)
        return ax

    panels = [(test, [panel(place, part) for part in range(parts)]) for place, test in enumerate(tests)]
    for test, (first, *_) in panels:
        first.set_title(f"{label(found.data, test)}\n{misfit_label(found, test)}", fontsize=8.5)
    return figure, panels


def label_sides(panels: Sequence[tuple[int, Sequence[Axes]]], *words: str) -> None:
    """Label the y axes of the panels at the left, from above."""
    for _, axes in panels[::COLUMNS]:
        for ax, text in zip(axes, words, strict=True):
            ax.set_ylabel(text, fontsize=8.5)


def rate(data: xr.Dataset, displacement: np.ndarray, test: int) -> np.ndarray:
    """Differentiate one period of a displacement (m) of a test; m/s."""
    orders = np.fft.rfftfreq(displacement.size, 1.0 / displacement.size)
    turn = 2j * np.pi * data["frequency"].values[test] * orders
    return np.fft.irfft(turn * np.fft.rfft(displacement), displacement.size)


def motion(data: xr.Dataset, waveform: xr.DataArray, test: int) -> tuple[np.ndarray, np.ndarray]:
    """Displacement and velocity of a test over one period; differentiated where there is no channel."""
    one = waveform.isel(test=test)
    displacement = one.sel(channel="displacement").values
    if "velocity" in data["channel"].values:
        velocity = one.sel(channel="velocity").values
        if np.isfinite(velocity).all():
            return displacement, velocity
    return displacement, rate(data, displacement, test)


def closed(values: np.ndarray) -> np.ndarray:
    """Repeat the first sample of a period at its end."""
    return np.append(values, values[:1])


def per_test_height(count: int) -> float:
    """Inches that a row per test takes."""
    return 0.9 + 0.21 * count
