"""One number per test, measured and simulated, a row each."""

import numpy as np
from matplotlib.figure import Figure

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look


def shown(found: Diagnosed, name: str) -> np.ndarray:
    """Indices of the tests in which ``measured_<name>`` is known, as a bench would run them."""
    order = look.by_frequency(found.data)
    return order[np.isfinite(found.data[f"measured_{name}"].values[order])]


def draw_values(ax, found: Diagnosed, order: np.ndarray, name: str, factor: float) -> None:
    """Draw the measured number of each test as a dot, and those of the models."""
    rows = np.arange(order.size)
    ax.plot(found.data[f"measured_{name}"].values[order] * factor, rows, **look.MEASURED_DOT)
    for model in found.models:
        values = found.data[f"simulated_{name}"].sel(model=model).values[order] * factor
        ax.plot(values, rows, **look.dot(model))
    ax.set_ylim(order.size - 0.4, -0.6)


def draw_ratios(ax, found: Diagnosed, order: np.ndarray, name: str) -> None:
    """Draw what each model has over what was measured."""
    rows = np.arange(order.size)
    measured = found.data[f"measured_{name}"].values[order]
    ax.axvline(1.0, color="black", linewidth=1.0)
    for model in found.models:
        values = found.data[f"simulated_{name}"].sel(model=model).values[order]
        ax.plot(values / np.where(measured == 0.0, np.nan, measured), rows, **look.dot(model))
    ax.set_ylim(order.size - 0.4, -0.6)
    ax.set_yticks(rows, [""] * rows.size)


def panels(found: Diagnosed, order: np.ndarray, count: int) -> tuple[Figure, list]:
    """Make panels side by side with a row per test, their names on the left."""
    height = max(look.per_test_height(order.size), 2.0)
    figure, axes = style.panels(
        count, columns=count, size=(3.6 if count > 1 else 5.0, height), share=False, margin=(1.4, 0.7)
    )
    axes[0].set_yticks(np.arange(order.size), [look.label(found.data, test) for test in order])
    for ax in axes:
        ax.tick_params(labelsize=8)
    return figure, axes
