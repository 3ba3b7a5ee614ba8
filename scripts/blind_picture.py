"""Recovery of a hidden effect over the excess chi-squared of the base model."""

from collections.abc import Sequence
from math import isfinite, nan, sqrt
from pathlib import Path

import numpy as np
from blind_statistics import Share

Rows = Sequence[tuple[float, float, dict[str, Share]]]
LEAST = 50.0
# A share of fewer sets is no share.
FEWEST = 3


def draw(rows: Rows, file: Path) -> None:
    """Write the figure: the share of sets per bin, with 95 % intervals for the diagnosis."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7.0, 4.2), layout="constrained")
    middles = np.array([_middle(low, high) for low, high, _ in rows])
    names = list(rows[0][2])
    # Side by side, so that equal shares stay visible.
    for name, places in zip(names, middles * np.geomspace(0.9, 1.1, len(names))[:, None], strict=True):
        shares = [found[name] for _, _, found in rows]
        values = [each.value if each.n >= FEWEST else nan for each in shares]
        if name in ("exact", "exact or tied"):
            ends = [each.wilson for each in shares]
            # Rounding may put the end of an interval behind a share of 0 or 1.
            errors = [
                [max(v - low, 0.0) for v, (low, _) in zip(values, ends, strict=True)],
                [max(high - v, 0.0) for v, (_, high) in zip(values, ends, strict=True)],
            ]
            axes.errorbar(places, values, yerr=errors, marker="o", capsize=3, label=f"diagnosis: {name}")
        elif name == "reported":
            axes.plot(places, values, marker=".", label="diagnosis: among what is reported")
        else:
            axes.plot(places, values, "--", marker=".", label=name)
    axes.set(
        xscale="log",
        xlabel="excess chi-squared of the base model",
        ylabel="share of sets with the truth",
        ylim=(-0.03, 1.03),
    )
    axes.axvline(800.0, color="0.6", linewidth=0.8)
    axes.grid(alpha=0.3)
    figure.legend(fontsize="small", loc="outside lower center", ncols=2, frameon=False)
    figure.savefig(file, dpi=150)
    plt.close(figure)


def _middle(low: float, high: float) -> float:
    """Geometric middle of a bin; an open one is as wide as its neighbour."""
    low = max(low, LEAST)
    return sqrt(low * high) if isfinite(high) else low * sqrt(2.0)
