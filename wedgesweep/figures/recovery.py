"""Recovery of a hidden effect over its strength, from a validation campaign.

No figure of a dataset: ``python -m wedgesweep.validation`` draws it from its records.
"""

from collections.abc import Sequence
from math import isfinite, nan, sqrt
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from wedgesweep.figures import style
from wedgesweep.figures.panels import panels

# Lower edge of the first bin, which starts at 0.
LEAST = 50.0
# A share of fewer sets is not drawn.
FEWEST = 3
STRONG = 800.0


def draw(bins: Sequence[Any]) -> Figure:
    """Draw the share of sets with the truth by method, with 95 % intervals for the diagnosis.

    ``bins`` are those of ``validation.tables.recovery``.
    """
    made = panels(None, 1, size=(6.2, 3.6))
    ax = made.axes[0]
    middles = np.array([_middle(low, high) for low, high, _ in bins])
    names = list(bins[0].shares)
    # Side by side, so that equal shares stay visible.
    for name, x in zip(names, middles * np.geomspace(0.9, 1.1, len(names))[:, None], strict=True):
        shares = [found[name] for *_, found in bins]
        values = [each.value if each.n >= FEWEST else nan for each in shares]
        if name in ("exact", "exact or tied"):
            # Rounding may put the end of an interval beyond a share of 0 or 1.
            low, high = np.transpose([each.wilson for each in shares])
            errors = np.maximum([values - low, high - values], 0.0)
            ax.errorbar(x, values, yerr=errors, marker="o", capsize=3, label=f"diagnosis: {name}")
        elif name == "reported":
            ax.plot(x, values, marker=".", label="diagnosis: the truth is among what is reported")
        else:
            ax.plot(x, values, "--", marker=".", label=name)
    ax.set(xscale="log", ylim=(-0.03, 1.03))
    ax.axvline(STRONG, color=style.GREY, linewidth=0.8)
    beside = {"transform": ax.get_xaxis_transform(), "fontsize": 8, "color": style.GREY}
    ax.text(1.03 * STRONG, 0.02, f"excess {STRONG:g}: enough to be named", **beside)
    style.label([ax], "excess chi-squared of the base model [1]", "share of sets with the truth [1]")
    made.title(
        "How often the hidden effect is found, over how strongly it shows",
        "excess: chi-squared of the base model over what noise leaves; bars: 95 % intervals",
    )
    made.legend(*ax.get_legend_handles_labels(), columns=2)
    return made.figure.figure


def _middle(low: float, high: float) -> float:
    """Geometric mean of a bin's edges; an open bin is as wide as its neighbour."""
    low = max(low, LEAST)
    return sqrt(low * high) if isfinite(high) else low * sqrt(2.0)
