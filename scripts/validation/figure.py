"""Recovery of a hidden effect over its strength, from a validation campaign.

Drawn from the records of a campaign.
"""

from collections.abc import Sequence
from math import isfinite, nan, sqrt
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from wedgesweep.figures import style
from wedgesweep.figures.panels import panels

# Lower edge of the first bin, which starts at 0.
LEAST = 50.0
# A share of fewer sets is not drawn.
FEWEST = 3
STRONG = 800.0
# What the shares of the diagnosis are shares of; the other methods are baselines on the same sets.
DIAGNOSIS = {
    "exact": "diagnosis: the truth is named",
    "exact or tied": "diagnosis: named, or in a tie",
    "reported": "diagnosis: reported at all",
}


def draw(bins: Sequence[Any]) -> Figure:
    """Draw a panel per method: the share of sets with the truth, with 95 % intervals.

    ``bins`` are those of ``tables.recovery``.
    """
    names = list(bins[0].shares)
    made = panels(None, len(names), size=(2.9, 2.3), margin=(0.8, 0.8))
    middles = np.array([_middle(low, high) for low, high, _ in bins])
    for place, (ax, name) in enumerate(zip(made.axes, names, strict=True)):
        _draw_method(ax, middles, [found[name] for *_, found in bins], name in DIAGNOSIS)
        ax.set_title(DIAGNOSIS.get(name, f"baseline: {name}"), fontsize=9.5)
        ax.axvline(STRONG, color=style.GREY, linewidth=0.8)
        if place == 0:
            beside = {"transform": ax.get_xaxis_transform(), "fontsize": 8, "color": style.GREY}
            ax.text(1.1 * STRONG, 0.05, f"{STRONG:g}: strong\nenough to be\nnamed", **beside)
    made.axes[0].set(xscale="log", ylim=(-0.03, 1.03))
    style.label(made.axes, "excess chi-squared [1]", "share of sets [1]")
    made.title(
        "How often the hidden effect is found, over how strongly it shows",
        "excess: chi-squared of the base model over what noise leaves; bars: 95 % intervals",
    )
    return made.figure.figure


def _draw_method(ax: Axes, middles: np.ndarray, shares: Sequence[Any], ours: bool) -> None:
    values = np.array([each.value if each.n >= FEWEST else nan for each in shares])
    low, high = np.transpose([each.wilson for each in shares])
    # Rounding may put the end of an interval beyond a share of 0 or 1.
    errors = np.maximum([values - low, high - values], 0.0)
    look: dict[str, Any] = {"linestyle": "-", "color": style.BLUE if ours else style.VERMILLION}
    ax.errorbar(middles, values, yerr=errors, marker="o", markersize=4, capsize=2.5, **look)


def _middle(low: float, high: float) -> float:
    """Geometric mean of a bin's edges; an open bin is as wide as its neighbour."""
    low = max(low, LEAST)
    return sqrt(low * high) if isfinite(high) else low * sqrt(2.0)
