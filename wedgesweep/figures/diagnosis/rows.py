"""One row per test: what a number was when measured, and what each model has for it."""

import numpy as np
from matplotlib.axes import Axes

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures.diagnosis import marks, selection
from wedgesweep.figures.panels import Panels, Target, panels


def known(result: DiagnosisResult, name: str) -> np.ndarray:
    """Return indices of the tests in which ``measured_<name>`` is known, as a bench would run them."""
    order = selection.by_frequency(result.data)
    return order[np.isfinite(result.data[f"measured_{name}"].values[order])]


def height(count: int) -> float:
    """Return the height (inches) of a panel with a row per test."""
    return 0.9 + 0.21 * count


def make_panels(target: Target, result: DiagnosisResult, order: np.ndarray, count: int) -> Panels:
    """Make panels side by side with a row per test, named on the left."""
    size = 3.6 if count > 1 else 5.0, max(height(order.size), 2.0)
    made = panels(target, count, columns=count, size=size, share=False, margin=(1.4, 0.7))
    for place, ax in enumerate(made.axes):
        set_rows(ax, result, order, named=place == 0)
        ax.tick_params(labelsize=8)
    return made


def set_rows(ax: Axes, result: DiagnosisResult, order: np.ndarray, named: bool) -> None:
    """Give each test a row, from above, with or without its name."""
    labels = [selection.label(result.data, test) if named else "" for test in order]
    ax.set_yticks(range(order.size), labels)
    ax.set_ylim(order.size - 0.5, -0.5)


def draw_values(ax: Axes, result: DiagnosisResult, order: np.ndarray, name: str, factor: float) -> None:
    """Draw the measured number of each test as a dot, and those of the models."""
    rows = np.arange(order.size)
    ax.plot(result.data[f"measured_{name}"].values[order] * factor, rows, **marks.MEASURED_DOT)
    for model in result.models:
        values = result.data[f"simulated_{name}"].sel(model=model).values[order] * factor
        ax.plot(values, rows, **marks.dot(model))


def draw_ratios(ax: Axes, result: DiagnosisResult, order: np.ndarray, name: str) -> None:
    """Draw the simulated over the measured number."""
    measured = result.data[f"measured_{name}"].values[order]
    ax.axvline(1.0, color="black", linewidth=1.0)
    for model in result.models:
        values = result.data[f"simulated_{name}"].sel(model=model).values[order]
        ratios = values / np.where(measured == 0.0, np.nan, measured)
        ax.plot(ratios, np.arange(order.size), **marks.dot(model))
